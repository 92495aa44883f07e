#include "sweep/judge.h"

#include "image/hash.h"
#include "quality/compare.h"
#include "results/describe.h"

namespace oitlab {

nlohmann::json Judge::judge(const std::string& id, std::span<const std::byte> bytes,
                            const Image& image) {
  const std::string hash = imageHash(bytes);
  const std::string file = id + ".png";
  const auto [verdict, isNew] = known_.try_emplace(hash);
  if (isNew) {
    claim_.writeImage(file, image);
    verdict->second.file = file;
    if (reference_) {
      verdict->second.quality = describeComparison(compareImages(image, *reference_));
      verdict->second.quality["reference"] = name_;
    }
  } else if (verdict->second.file != file) {
    claim_.copyImage(verdict->second.file, file);
  }
  return {{"quality", verdict->second.quality},
          {"image_hash", hash},
          {"image", {{"file", "images/" + file}}}};
}

}  // namespace oitlab

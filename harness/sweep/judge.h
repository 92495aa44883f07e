#pragma once

#include "image/image.h"
#include "results/group_claim.h"

namespace oitlab {

/// Scores the images of one group against the reference's, and keeps them for the commit. Many
/// cells of a group have the same image: it is judged and encoded once.
class Judge {
 public:
  /// `reference`: none where images are not scored; `name` is the method that made it.
  Judge(std::optional<Image> reference, std::string name, GroupClaim& claim)
      : reference_(std::move(reference)), name_(std::move(name)), claim_(claim) {}

  /// {"quality", "image_hash", "image"} of the cell `id`. `bytes` is the image as the target stores
  /// it, and `image` the same in floats.
  nlohmann::json judge(const std::string& id, std::span<const std::byte> bytes, const Image& image);

 private:
  struct Verdict {
    nlohmann::json quality;
    std::string file;
  };
  std::optional<Image> reference_;
  std::string name_;
  GroupClaim& claim_;
  std::map<std::string, Verdict> known_;  ///< by hash
};

}  // namespace oitlab

#include "results/cell_check.h"

#include <fmt/format.h>

namespace oitlab {
namespace {

using nlohmann::json;
using Pointer = json::json_pointer;

/// The value at `pointer`, null where there is none.
const json& at(const json& cell, const char* pointer) {
  static const json none;
  const Pointer place(pointer);
  return cell.contains(place) ? cell.at(place) : none;
}

bool isText(const json& value) {
  return value.is_string() && !value.get_ref<const std::string&>().empty();
}

bool isTime(const json& value) {
  return value.is_number() && value.get<double>() > 0;
}

}  // namespace

std::string findDamage(const json& cell, const std::string& id,
                       const std::filesystem::path& results) {
  if (!cell.is_object()) return "it is no JSON object";
  if (at(cell, "/schema") != cellSchema)
    return fmt::format("its schema is {}, wanted {}", at(cell, "/schema").dump(), cellSchema);
  if (at(cell, "/id") != id) return fmt::format("its id is {}", at(cell, "/id").dump());
  for (const char* text : {"/group", "/provenance/commit"})
    if (!isText(at(cell, text))) return fmt::format("it has no {}", text + 1);
  const json& status = at(cell, "/status");
  if (status == "skipped" || status == "failed")
    return isText(at(cell, "/reason")) ? "" : "it gives no reason";
  if (status != "ok") return fmt::format("its status is {}", status.dump());

  for (const char* time : {"/gpu_ms/frame", "/statistics/frame/median"})
    if (!isTime(at(cell, time))) return fmt::format("it has no {}", time + 1);
  const json& times = at(cell, "/samples/frame_ms");
  const json& blocks = at(cell, "/samples/block");
  if (!times.is_array() || times.empty() || !blocks.is_array() || blocks.size() != times.size())
    return "it has no samples, or not the block of each";
  if (isText(at(cell, "/reference")) && !at(cell, "/quality").is_object())
    return "it was not scored against its reference";
  const json& image = at(cell, "/image/file");
  std::error_code missing;
  if (!isText(image)) return "it has no image";
  if (!std::filesystem::is_regular_file(results / image.get<std::string>(), missing))
    return fmt::format("its image {} is not there", image.get<std::string>());
  return "";
}

}  // namespace oitlab

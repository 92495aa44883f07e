#include "results/results_folder.h"

#include <fstream>

#include "results/cell_check.h"
#include "util/error.h"
#include "util/json_file.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// "a; b; and 3 more".
std::string shortList(const std::vector<std::string>& items) {
  constexpr std::size_t most = 2;
  std::string text = fmt::format(
      "{}",
      fmt::join(items.begin(), items.begin() + std::ptrdiff_t(std::min(items.size(), most)), "; "));
  if (items.size() > most) text += fmt::format("; and {} more", items.size() - most);
  return text;
}

void makeWritable(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    fail<OutputError>("{}: results cannot be written there: {}", folder.string(), error.message());
  const fs::path probe = folder / ".writable";
  std::ofstream file(probe);
  if (!(file << "x" << std::flush))
    fail<OutputError>("{}: results cannot be written there: {}", folder.string(),
                      std::strerror(errno));
  file.close();
  fs::remove(probe, error);
}

}  // namespace

bool GroupState::fromOneRun() const {
  std::set<std::string> groups;
  for (const CellState& cell : cells) groups.insert(cell.group);
  return groups.size() == 1 && !groups.contains("");
}

bool GroupState::lacksOnlyFailed() const {
  const std::size_t failures = count(CellState::failed);
  return failures > 0 && fromOneRun() && failures + count(CellState::there) == cells.size();
}

std::size_t GroupState::count(CellState::Kind kind) const {
  return std::size_t(std::count_if(cells.begin(), cells.end(),
                                   [&](const CellState& cell) { return cell.kind == kind; }));
}

std::string GroupState::whyAgain() const {
  const std::size_t absent = count(CellState::missing);
  if (absent == cells.size()) return "";
  for (const CellState::Kind kind : {CellState::damaged, CellState::different, CellState::failed})
    for (const CellState& cell : cells)
      if (cell.kind == kind) return cell.reason;
  if (absent > 0) return fmt::format("{} of {} cells are missing", absent, cells.size());
  return "its cells were measured in different runs";
}

ResultsFolder::ResultsFolder(fs::path path, const DeviceInfo& device, MeasuredWith with, bool keep)
    : path_(std::move(path)), device_(device), with_(std::move(with)), keep_(keep) {}

void ResultsFolder::make() const {
  makeWritable(path_ / "cells");
  makeWritable(path_ / "images");
}

GroupState ResultsFolder::look(const std::vector<CellSpec>& group) {
  GroupState state;
  for (const CellSpec& cell : group) state.cells.push_back(look(cell));
  return state;
}

CellState ResultsFolder::look(const CellSpec& cell) {
  CellState state;
  const std::string id = cellId(cell, device_);
  const fs::path file = path_ / "cells" / (id + ".json");
  std::error_code error;
  if (!fs::exists(file, error)) return state;
  json content;
  std::string damage;
  try {
    content = readJsonFile(file);
    damage = findDamage(content, id, path_);
  } catch (const InputError& unreadable) {
    damage = unreadable.what();
  }
  const auto schema = content.is_object() ? content.find("schema") : content.end();
  if (schema != content.end() && schema->is_number_integer() && *schema > cellSchema)
    fail<InputError>(
        "{}: its schema is {}, which a newer version wrote; this one knows {}: measure into "
        "another folder, or with that version",
        file.string(), schema->dump(), cellSchema);
  if (!damage.empty()) {
    state.kind = CellState::damaged;
    state.reason = fmt::format("{} is no whole cell: {}", file.string(), damage);
    return state;
  }
  state.group = content["group"].get<std::string>();
  state.validationMessages = content.value("validation_messages", std::uint64_t(0));
  if (content["status"] == "failed") {
    state.kind = CellState::failed;
    state.reason = fmt::format("{} failed: {}", cell.label(), content["reason"].get<std::string>());
    return state;
  }
  state.kind = CellState::there;
  const auto differences = with_.differences(content);
  if (differences.empty()) return state;
  state.reason = fmt::format("{}: {}", cell.label(), shortList(differences));
  if (keep_)
    kept_.insert(state.reason);
  else
    state.kind = CellState::different;
  return state;
}

}  // namespace oitlab

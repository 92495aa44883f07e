#include "results/group_claim.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <condition_variable>
#include <mutex>

#include "util/error.h"
#include "util/json_file.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;

constexpr const char* ownerSuffix = ".owner";
constexpr const char* doneSuffix = ".done";        // committed, files to be moved
constexpr const char* droppedSuffix = ".dropped";  // to be removed
constexpr const char* newSuffix = ".new";          // about to become a claim

/// A full disk or a folder that is gone is no mistake in the input.
template <typename Write>
void asOutput(Write&& write) {
  try {
    write();
  } catch (const InputError& error) {
    throw OutputError(error.what());
  }
}

void checkOutput(const fs::path& path, const std::error_code& error) {
  if (error) fail<OutputError>("{}: cannot be written: {}", path.string(), error.message());
}

/// A folder below running/. The last process to end removes running/, and may do so between the
/// steps of this: then they begin again. Each such try needs another process that just ended, so
/// a hundred in a row are no accident.
void makeFolder(const fs::path& folder) {
  std::error_code error;
  for (int tries = 0; tries < 100; ++tries) {
    fs::create_directories(folder, error);
    if (error != std::errc::no_such_file_or_directory) break;
  }
  checkOutput(folder, error);
}

/// What is in a folder that other processes may be changing; nothing where it is gone.
std::vector<fs::path> entriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    entries.push_back(entry->path());
  return entries;
}

/// The file TOKEN.owner of a claim; empty where there is none.
fs::path findOwnerFile(const fs::path& claim) {
  for (const fs::path& entry : entriesOf(claim))
    if (entry.extension() == ownerSuffix) return entry;
  return {};
}

/// Nobody's where the file cannot be read.
Owner readOwner(const fs::path& file) {
  try {
    return Owner::fromJson(readJsonFile(file));
  } catch (const InputError&) {
    return {};  // half-written by a foreign hand, or just gone
  }
}

/// Whether nobody has touched `path` for as long as the lease lasts before `now`. Both are times of
/// the file system, which may be another machine's. A time that lies as far in the future is from
/// before a clock was set back: whoever is alive will touch the file again, by the new clock.
bool isOld(const fs::path& path, fs::file_time_type now, std::chrono::milliseconds lease) {
  std::error_code gone;
  const auto touched = fs::last_write_time(path, gone);
  return gone ? false : now - touched > lease || touched - now > lease;
}

/// What time the file system says it is: that of a file that was written just now.
fs::file_time_type fileSystemNow(const fs::path& folder) {
  const fs::path probe = folder / (Owner::self().token + newSuffix);
  makeFolder(probe);
  std::error_code error;
  const auto now = fs::last_write_time(probe, error);
  checkOutput(probe, error);
  fs::remove(probe, error);
  return now;
}

/// Renames `claim` away, provided that it is still the one with this owner file, and removes it.
void dropClaim(const fs::path& running, const fs::path& claim, const fs::path& ownerFile) {
  const fs::path aside = running / (Owner::self().token + droppedSuffix);
  std::error_code error;
  fs::rename(claim, aside, error);
  if (error) return;  // another process was faster
  if (!ownerFile.empty() && !fs::exists(aside / ownerFile.filename(), error)) {
    // In between another process took it over: that one's claim is given back.
    fs::rename(aside, claim, error);
    if (!error) return;
  }
  fs::remove_all(aside, error);
}

bool isStale(const fs::path& claim, const fs::path& ownerFile, fs::file_time_type now,
             std::chrono::milliseconds lease) {
  if (ownerFile.empty()) return isOld(claim, now, lease);
  return readOwner(ownerFile).isDead() || isOld(ownerFile, now, lease);
}

/// Moves the files of a committed claim to where they belong. A file that is not there any more was
/// moved by another process.
void moveFiles(const fs::path& results, const fs::path& done) {
  std::error_code error, ignored;
  // Images first: a cell that is there has its image.
  for (const char* kind : {"images", "cells"})
    for (const fs::path& file : entriesOf(done / kind)) {
      const fs::path target = results / kind / file.filename();
      fs::rename(file, target, error);
      const bool movedByAnother = error == std::errc::no_such_file_or_directory &&
                                  fs::is_directory(results / kind, ignored);
      if (!movedByAnother) checkOutput(target, error);
    }
  fs::remove_all(done, ignored);
}

}  // namespace

std::unique_ptr<GroupClaim> GroupClaim::take(const fs::path& results, const std::string& key,
                                             std::string& holder, Terms terms) {
  const fs::path running = results / "running";
  const fs::path claim = running / key;
  makeFolder(running);
  std::error_code error;
  if (fs::exists(claim, error)) {
    const fs::path ownerFile = findOwnerFile(claim);
    if (!isStale(claim, ownerFile, fileSystemNow(running), terms.lease)) {
      holder = readOwner(ownerFile).describe();
      return nullptr;
    }
    dropClaim(running, claim, ownerFile);
  }
  const Owner owner = Owner::self();
  const fs::path fresh = running / (owner.token + newSuffix);
  for (const char* kind : {"images", "cells"}) makeFolder(fresh / kind);
  asOutput([&] { writeJsonFile(fresh / (owner.token + ownerSuffix), owner.toJson()); });
  fs::rename(fresh, claim, error);
  if (error) {
    std::error_code ignored;
    fs::remove_all(fresh, ignored);
    if (error != std::errc::directory_not_empty && error != std::errc::file_exists)
      checkOutput(claim, error);
    holder = readOwner(findOwnerFile(claim)).describe();
    return nullptr;
  }
  std::unique_ptr<GroupClaim> taken(new GroupClaim(results, key, owner));
  taken->heartbeat_ =
      std::jthread([claimed = taken.get(), beat = terms.heartbeat](std::stop_token stop) {
        claimed->keepAlive(std::move(stop), beat);
      });
  return taken;
}

GroupClaim::GroupClaim(fs::path results, std::string key, Owner owner)
    : results_(std::move(results)),
      folder_(results_ / "running" / key),
      key_(std::move(key)),
      owner_(std::move(owner)) {}

GroupClaim::~GroupClaim() {
  heartbeat_.request_stop();
  if (heartbeat_.joinable()) heartbeat_.join();
  if (committed_) return;
  dropClaim(folder_.parent_path(), folder_, ownerFile());
  std::error_code ignored;
  fs::remove(folder_.parent_path(), ignored);  // unless other groups are in it
}

void GroupClaim::keepAlive(std::stop_token stop, std::chrono::milliseconds heartbeat) const {
  std::mutex mutex;
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  while (!ended.wait_for(lock, stop, heartbeat, [&] { return stop.stop_requested(); })) {
    // The file system's own time, which on a file server is not this machine's. No file is made:
    // the folder of this name may be another process's by now. Where it fails, commit() tells.
    utimensat(AT_FDCWD, ownerFile().c_str(), nullptr, 0);
  }
}

void GroupClaim::writeCell(const std::string& id, const nlohmann::json& content) {
  asOutput([&] { writeJsonFile(folder_ / "cells" / (id + ".json"), content); });
}

void GroupClaim::writeImage(const std::string& name, const Image& image) {
  asOutput([&] { oitlab::writeImage(folder_ / "images" / name, image); });
}

void GroupClaim::copyImage(const std::string& from, const std::string& name) {
  const fs::path target = folder_ / "images" / name;
  std::error_code error;
  fs::copy_file(folder_ / "images" / from, target, fs::copy_options::overwrite_existing, error);
  checkOutput(target, error);
}

bool GroupClaim::isHeld() const {
  std::error_code ignored;
  return fs::exists(ownerFile(), ignored);
}

bool GroupClaim::commit() {
  if (!isHeld()) return false;
  const fs::path done = folder_.parent_path() / fmt::format("{}.{}{}", key_, token(), doneSuffix);
  std::error_code error, ignored;
  fs::rename(folder_, done, error);
  checkOutput(done, error);
  if (!fs::exists(done / ownerFile().filename(), ignored)) {
    fs::rename(done, folder_, ignored);  // taken over since isHeld(): it is another's claim
    return false;
  }
  committed_ = true;
  moveFiles(results_, done);
  fs::remove(folder_.parent_path(), error);  // unless other groups are in it
  return true;
}

void finishCommits(const fs::path& results, GroupClaim::Terms terms) {
  const fs::path running = results / "running";
  std::error_code error;
  if (!fs::is_directory(running, error)) return;
  const auto now = fileSystemNow(running);
  for (const fs::path& path : entriesOf(running)) {
    if (path.extension() == doneSuffix) {
      moveFiles(results, path);
    } else if (path.extension() == droppedSuffix || path.extension() == newSuffix) {
      if (isOld(path, now, terms.lease)) fs::remove_all(path, error);
    } else if (const fs::path owner = findOwnerFile(path); isStale(path, owner, now, terms.lease)) {
      dropClaim(running, path, owner);
    }
  }
  fs::remove(running, error);  // unless something is in it
}

}  // namespace oitlab

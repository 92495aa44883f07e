#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "image/image.h"
#include "results/owner.h"

namespace oitlab {

/// One process's right to measure a group of cells, and what it has of them so far. Any number of
/// processes may share a results folder: each group is measured by one of them at a time, and its
/// cells appear in the folder all at once or not at all.
///
/// A claim is the folder running/KEY within the results. It holds `TOKEN.owner`, whose modification
/// time is the heartbeat, and the files to be committed, in cells/ and images/. The claim is taken
/// by a rename onto that name, which fails while there is one. A commit renames the folder to
/// running/KEY.TOKEN.done, and then moves the files: the first rename decides. finishCommits() does
/// what is left of the second step when a process was killed in it.
class GroupClaim {
 public:
  /// A claim without a heartbeat for as long as `lease` is stale: whoever held it is dead or cut
  /// off. Several heartbeats, so that one that a busy file server delayed does not lose the claim.
  struct Terms {
    std::chrono::milliseconds lease{60'000};
    std::chrono::milliseconds heartbeat{10'000};
  };

  /// Null while another process holds the group; `holder` says which. A stale claim, or one of a
  /// process that is known to be dead, is taken over, and what it held is dropped. The folders
  /// cells and images must exist in `results`. Throws OutputError where the folder cannot be
  /// written.
  static std::unique_ptr<GroupClaim> take(const std::filesystem::path& results,
                                          const std::string& key, std::string& holder, Terms terms);
  static std::unique_ptr<GroupClaim> take(const std::filesystem::path& results,
                                          const std::string& key, std::string& holder) {
    return take(results, key, holder, Terms());
  }

  /// Without a commit() all is dropped.
  ~GroupClaim();
  GroupClaim(const GroupClaim&) = delete;
  GroupClaim& operator=(const GroupClaim&) = delete;

  /// Kept for the commit. Throw OutputError.
  void writeCell(const std::string& id, const nlohmann::json& content);
  void writeImage(const std::string& name, const Image& image);
  /// An image that was written already, under another name.
  void copyImage(const std::string& from, const std::string& name);

  /// False once another process took the group over.
  bool isHeld() const;

  /// Moves all into the results folder. False, and all is dropped, where the group was taken over.
  /// Throws OutputError.
  bool commit();

  const std::string& token() const { return owner_.token; }

 private:
  GroupClaim(std::filesystem::path results, std::string key, Owner owner);
  void keepAlive(std::stop_token stop, std::chrono::milliseconds heartbeat) const;
  std::filesystem::path ownerFile() const { return folder_ / (owner_.token + ".owner"); }

  std::filesystem::path results_, folder_;
  std::string key_;
  Owner owner_;
  bool committed_ = false;
  std::jthread heartbeat_;
};

/// Finishes the commits of processes that were killed in the middle of one, and removes what dead
/// or cut-off processes left in running/. Any number of processes may do so at once. Throws
/// OutputError.
void finishCommits(const std::filesystem::path& results, GroupClaim::Terms terms = {});

}  // namespace oitlab

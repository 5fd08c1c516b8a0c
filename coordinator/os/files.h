// Files and folders that several processes look at.
#pragma once

#include <string>

#include "coordinator/port/unique_fd.h"

namespace tcs {

// The events that a file outlives: the death of any process, or of the machine, too, which takes
// the disk's time.
enum class Withstands { kCrash, kPowerCut };

// A process that reads `path` finds all of the text or what was there before, whatever dies
// meanwhile. Empty on success, else one sentence.
[[nodiscard]] std::string WriteWhole(const std::string& path, const std::string& text,
                                     Withstands what = Withstands::kPowerCut);

// Makes the folder and those above it. Empty on success, else one sentence that names --out.
[[nodiscard]] std::string MakeFolder(const std::string& path);

// The absolute path of `path`, without "." and "..", and without a slash at its end.
[[nodiscard]] std::string AbsolutePathOf(const std::string& path);

// Removes the file, or the folder with all that is in it, as far as that is allowed.
void RemoveAll(const std::string& path);

// Copies what is in one folder into another, which is there: files with their permissions, folders
// and symbolic links; no sockets, pipes and devices. Empty on success, else one sentence.
[[nodiscard]] std::string CopyFolder(const std::string& from, const std::string& to);

// The last line of a text file that is not empty, cut to what fits a sentence; empty if there is
// none, or no such file. Reads the file's end only.
[[nodiscard]] std::string LastLine(const std::string& path);

// A folder that one process at a time works in; free again when its holder ends, however that
// happens.
class FolderLock {
 public:
  FolderLock() = default;
  // Does not wait. Where the file system knows no locks, the folder counts as ours.
  explicit FolderLock(const std::string& path);

  // False while another process holds it.
  bool IsOurs() const { return is_ours_; }

 private:
  UniqueFd fd_;
  bool is_ours_ = false;
};

}  // namespace tcs

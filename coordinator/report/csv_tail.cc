#include "coordinator/report/csv_tail.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace tcs::report {

namespace {

constexpr std::size_t kMostAtOnce = 16 << 20;

}  // namespace

CsvTail::CsvTail(std::string path, std::vector<std::string_view> columns, std::size_t needed)
    : path_(std::move(path)), columns_(std::move(columns)), needed_(needed) {}

bool CsvTail::Open() {
  file_.Reset(open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat is {};
  if (!file_ || fstat(file_.get(), &is) != 0 || !S_ISREG(is.st_mode)) {
    file_.Reset();
    return false;
  }
  inode_ = is.st_ino;
  return true;
}

void CsvTail::TakeHead(std::string_view line) {
  has_head_ = true;
  CsvFields names;
  SplitCsv(line, &names);
  for (const std::string_view column : columns_) {
    const auto found = std::find(names.begin(), names.end(), column);
    if (found == names.end()) {
      places_.resize(places_.size() < needed_ ? 0 : needed_);
      return;
    }
    places_.push_back(static_cast<std::size_t>(found - names.begin()));
  }
}

CsvTail::Found CsvTail::Look(const std::function<Taken(const CsvFields&)>& take) {
  if (!file_ && !Open()) return Found::kMore;
  struct stat is {};
  if (stat(path_.c_str(), &is) != 0 || is.st_ino != inode_ || is.st_size < offset_) {
    return Found::kReplaced;
  }
  const std::size_t before = text_.size();
  const auto more =
      std::min<std::size_t>(static_cast<std::size_t>(is.st_size - offset_), kMostAtOnce);
  text_.resize(before + more);
  const ssize_t got = pread(file_.get(), text_.data() + before, more, offset_);
  text_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  offset_ += std::max<ssize_t>(0, got);
  std::string_view rest = text_;
  CsvFields line, wanted;
  for (std::size_t end; (end = rest.find('\n')) != std::string_view::npos;
       rest.remove_prefix(end + 1)) {
    if (!has_head_) {
      TakeHead(rest.substr(0, end));
      continue;
    }
    SplitCsv(rest.substr(0, end), &line);
    if (places_.empty() || line.size() <= *std::max_element(places_.begin(), places_.end()))
      continue;
    wanted.resize(places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) wanted[i] = line[places_[i]];
    if (take(wanted) == Taken::kLater) break;
  }
  text_.erase(0, text_.size() - rest.size());
  return Found::kMore;
}

}  // namespace tcs::report

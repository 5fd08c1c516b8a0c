#include "coordinator/trace/csv_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace tcs {

namespace {

constexpr std::size_t kBufferBytes = 64 << 10;
// More than any line takes, texts (below) included.
constexpr std::size_t kLongestLine = 1024;
constexpr std::size_t kLongestText = 256;

}  // namespace

CsvFile::~CsvFile() {
  if (file_ != nullptr) std::fclose(file_);
}

std::string CsvFile::Open(const std::string& path, std::string_view header) {
  path_ = path;
  file_ = std::fopen(path.c_str(), "we");
  if (file_ == nullptr) return fmt::format("{} cannot be written: {}", path, strerror(errno));
  buffer_.resize(kBufferBytes);
  Put(header);
  Byte('\n');
  return {};
}

void CsvFile::Room() {
  if (buffer_.size() - used_ < kLongestLine) Flush();
}

void CsvFile::Flush() {
  std::fwrite(buffer_.data(), 1, used_, file_);
  used_ = 0;
}

void CsvFile::Put(std::string_view text) {
  const std::size_t size = std::min(text.size(), kLongestText);
  memcpy(buffer_.data() + used_, text.data(), size);
  used_ += size;
}

std::string CsvFile::Close() {
  if (file_ == nullptr) return {};
  Flush();
  const bool bad = std::ferror(file_) != 0;
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (bad || !closed) return fmt::format("{} was not written whole: {}", path_, strerror(errno));
  return {};
}

}  // namespace tcs

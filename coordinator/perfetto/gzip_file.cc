#include "coordinator/perfetto/gzip_file.h"

#include <zlib.h>

#include <cerrno>

#include "coordinator/os/file_errors.h"

namespace tcs::perfetto {

GzipFile::~GzipFile() {
  if (file_ != nullptr) gzclose(file_);
}

std::string GzipFile::Open(const std::string& path) {
  path_ = path;
  errno = 0;
  file_ = gzopen(path.c_str(), "wbe6");
  if (file_ == nullptr) return CannotBeWritten(path);
  gzbuffer(file_, 256 << 10);
  return {};
}

void GzipFile::Append(std::string_view text) {
  if (failed_ || text.empty()) return;
  errno = 0;
  failed_ = gzwrite(file_, text.data(), static_cast<unsigned>(text.size())) == 0;
}

std::string GzipFile::Close() {
  if (!failed_) errno = 0;
  const int error = errno;
  failed_ |= gzclose(file_) != Z_OK;
  file_ = nullptr;
  if (!failed_) return {};
  if (errno == 0) errno = error;
  return NotWrittenWhole(path_);
}

}  // namespace tcs::perfetto

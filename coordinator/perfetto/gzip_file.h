// A file that is compressed as it is written. The same text gives the same bytes each time.
#pragma once

#include <string>
#include <string_view>

struct gzFile_s;

namespace tcs::perfetto {

class GzipFile {
 public:
  GzipFile() = default;
  // Closes the file without a word if Close was not called.
  ~GzipFile();
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;

  // Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const std::string& path);
  void Append(std::string_view text);
  // Empty if nothing has gone wrong since Open, else one sentence.
  [[nodiscard]] std::string Close();

 private:
  gzFile_s* file_ = nullptr;
  std::string path_;
  bool failed_ = false;
};

}  // namespace tcs::perfetto

// A file of comma-separated numbers, written in large pieces: a line costs well under a
// microsecond. Texts are written as they are: names of clients need no quoting (docs/SCENARIO.md).
// Not thread-safe. What could not be written is reported by Close().
#pragma once

#include <charconv>
#include <concepts>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace tcs {

class CsvFile {
 public:
  CsvFile() = default;
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;

  // Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const std::string& path, std::string_view header);
  bool is_open() const { return file_ != nullptr; }

  // One line; texts and whole numbers.
  template <class... Fields>
  void Line(const Fields&... fields) {
    if (file_ == nullptr) return;
    Room();
    bool first = true;
    ((first ? void(first = false) : Byte(','), Put(fields)), ...);
    Byte('\n');
  }

  // Empty on success, else one sentence.
  [[nodiscard]] std::string Close();

 private:
  void Room();
  void Flush();
  void Byte(char byte) { buffer_[used_++] = byte; }
  void Put(std::string_view text);
  template <std::integral Number>
  void Put(Number number) {
    char* const from = buffer_.data() + used_;
    used_ += static_cast<std::size_t>(
        std::to_chars(from, buffer_.data() + buffer_.size(), number).ptr - from);
  }

  std::FILE* file_ = nullptr;
  std::string path_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
};

}  // namespace tcs

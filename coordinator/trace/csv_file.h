// A file of comma-separated texts and numbers. A line is only noted, as it is, and made into text
// with hundreds of others: between two dispatches next to nothing of the coordinator is in the
// CPU's caches, and code that formats, and what it needs, would be fetched anew for each line.
//
// Texts are written as they are: names of clients need no quoting (docs/SCENARIO.md). Not
// thread-safe. Close() reports what could not be written.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
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

  // Notes one line: texts, whole numbers, and other numbers with as many digits as tell them apart.
  template <class... Fields>
  void Line(const Fields&... fields) {
    if (file_ == nullptr) return;
    if (noted_.size() - used_ < kLongestLine) WriteNoted();
    (Note(fields), ...);
    Append(kLineEnd);
  }

  // Writes what is noted.
  void Flush();

  // Empty on success, else one sentence.
  [[nodiscard]] std::string Close();

 private:
  // More than any line takes when noted, texts (of kLongestText at most) included.
  static constexpr std::size_t kLongestLine = 1024, kLongestText = 256;

  // A mark before a field's bytes: a text's length, or that the field is a number, whole or not.
  // Another mark follows a line's last field.
  using Mark = std::uint16_t;
  static constexpr Mark kNumber = 0xffff, kLineEnd = 0xfffe, kReal = 0xfffd;

  template <class Bytes>
  void Append(const Bytes& bytes) {
    memcpy(noted_.data() + used_, &bytes, sizeof bytes);
    used_ += sizeof bytes;
  }
  void Note(std::integral auto number) {
    Append(kNumber);
    Append(static_cast<std::int64_t>(number));
  }
  void Note(double number) {
    Append(kReal);
    Append(number);
  }
  void Note(std::string_view text) {
    text = text.substr(0, kLongestText);
    Append(static_cast<Mark>(text.size()));
    memcpy(noted_.data() + used_, text.data(), text.size());
    used_ += text.size();
  }
  void WriteNoted();

  std::FILE* file_ = nullptr;
  std::string path_;
  std::vector<char> noted_;
  std::size_t used_ = 0;
};

}  // namespace tcs

#include "coordinator/text/csv.h"

#include <gtest/gtest.h>

#include <fstream>

namespace tcs {
namespace {

class CsvTest : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }

  LoadResult<std::int64_t> Read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return ReadCsv(path_, {"b", "a"}, [this](const CsvFields& fields) {
      const auto number = ToReal(fields[1]);
      if (!number) return false;
      lines_.push_back(std::string(fields[0]) + "=" + std::string(fields[1]));
      return true;
    });
  }
  static std::string Error(const LoadResult<std::int64_t>& result) {
    const auto* error = std::get_if<LoadError>(&result);
    return error == nullptr ? "" : error->message;
  }

  const std::string path_ = ::testing::TempDir() + "csv_test_" +
                            ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                            ".csv";
  std::vector<std::string> lines_;
};

TEST_F(CsvTest, ColumnsAreFoundByTheirNames) {
  const auto read = Read("a,x,b\n1,9,one\n2.5,9,two\r\n");
  EXPECT_EQ(std::get<std::int64_t>(read), 0);
  EXPECT_EQ(lines_, (std::vector<std::string>{"one=1", "two=2.5"}));
}

TEST_F(CsvTest, LinesOfNoUseAreCountedAndLeftOut) {
  const auto read = Read("a,b\n1,one\nnan,two\n\n3\n\xff\xfe,\"\n4,four\n5,cut off");
  EXPECT_EQ(std::get<std::int64_t>(read), 5);
  EXPECT_EQ(lines_, (std::vector<std::string>{"one=1", "four=4"}));
}

TEST_F(CsvTest, WhatIsMissingIsSaid) {
  EXPECT_NE(Error(Read("a,c\n1,2\n")).find("has no column 'b'"), std::string::npos);
  EXPECT_NE(Error(Read("")).find("is empty"), std::string::npos);
  const auto read = ReadCsv("/nonexistent.csv", {"a"}, [](const CsvFields&) { return true; });
  EXPECT_NE(Error(read).find("/nonexistent.csv cannot be read"), std::string::npos);
}

TEST(CsvNumbers, AreWholeAndFinite) {
  EXPECT_EQ(ToReal("1e-3"), 1e-3);
  EXPECT_FALSE(ToReal("1 m").has_value());
  EXPECT_FALSE(ToReal("inf").has_value());
  EXPECT_FALSE(ToReal("").has_value());
  EXPECT_EQ(ToInteger("-5"), -5);
  EXPECT_FALSE(ToInteger("99999999999999999999").has_value());
  EXPECT_FALSE(ToInteger("1.5").has_value());
}

}  // namespace
}  // namespace tcs

#include "coordinator/text/text_table.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

TEST(TextTable, NamesStandToTheLeftAndNumbersToTheRight) {
  TextTable table({{"client", false}, {"calls"}, {"reads", false}});
  table.Row({"hunter/planner", "7", "/odom"});
  table.Row({"a", "12345678", "-"});
  EXPECT_EQ(table.Text(),
            "client             calls  reads\n"
            "hunter/planner         7  /odom\n"
            "a               12345678  -\n");
}

TEST(TextTable, WithoutRowsHasItsTitles) {
  EXPECT_EQ(TextTable({{"topic", false}, {"rate"}}).Text(), "topic  rate\n");
}

TEST(TextTable, ACharacterTakesOnePlaceHoweverManyBytesItHas) {
  TextTable table({{"Δ"}, {"unit", false}});
  table.Row({"1.5", "µs"});
  EXPECT_EQ(table.Text(),
            "  Δ  unit\n"
            "1.5  µs\n");
}

TEST(TextTable, NotesStandUnderTheirRowAndMakeNoColumnWider) {
  TextTable table({{"topic", false}, {"rate"}});
  table.Row({"/odom", "5"});
  table.Note("    writer: a long name");
  table.Note("    reader: b");
  table.Row({"/tf", "10"});
  EXPECT_EQ(table.Text(),
            "topic  rate\n"
            "/odom     5\n"
            "    writer: a long name\n"
            "    reader: b\n"
            "/tf      10\n");
}

TEST(TextTable, LinesDoNotEndWithSpaces) {
  TextTable table({{"a", false}, {"b", false}});
  table.Row({"1", ""});
  table.Row({"", "long"});
  EXPECT_EQ(table.Text(), "a  b\n1\n   long\n");
}

TEST(TextTableDeath, ARowHasAsManyCellsAsThereAreColumns) {
  TextTable table({{"a"}, {"b"}});
  EXPECT_DEATH(table.Row({"1"}), "cells.size");
}

}  // namespace
}  // namespace tcs

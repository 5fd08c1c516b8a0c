#include "coordinator/tasks/task_table.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace tcs {
namespace {

class TaskTableTest : public testing::Test {
 protected:
  // Threads or processes that come and go, one after another.
  void PassThreads(int count) {
    for (int i = 0; i < count; ++i) table_.TaskEnded(table_.AddTask(next_++));
  }
  void PassProcesses(int count) {
    for (int i = 0; i < count; ++i) End(table_.AddProcess(next_++));
  }
  void End(Process& process) {
    table_.ProcessEnded(process);
    table_.GiveUp(process);
  }

  std::set<pid_t> unreaped_;
  TaskTable table_{[this](pid_t pid) { return !unreaped_.contains(pid); }};
  pid_t next_ = 1000;
};

TEST_F(TaskTableTest, ThreadsAreNumberedInTheOrderOfTheirComing) {
  EXPECT_EQ(table_.AddTask(10).order, 0);
  EXPECT_EQ(table_.AddTask(11).order, 1);
  EXPECT_EQ(table_.At(1).tid, 11);
  EXPECT_EQ(table_.AddProcess(10).index, 0u);
  EXPECT_EQ(table_.AddProcess(11).index, 1u);
  EXPECT_EQ(table_.ProcessAt(1).pid, 11);
}

TEST_F(TaskTableTest, OnlyTheLivingAreFoundByTheirNumbers) {
  Task& task = table_.AddTask(10);
  Process& process = table_.AddProcess(10);
  EXPECT_EQ(table_.Living(10), &task);
  EXPECT_EQ(table_.LivingProcess(10), &process);
  EXPECT_EQ(table_.living(), 1);
  table_.TaskEnded(task);
  table_.ProcessEnded(process);
  EXPECT_EQ(table_.Living(10), nullptr);
  EXPECT_EQ(table_.LivingProcess(10), nullptr);
  EXPECT_EQ(table_.living(), 0);
}

TEST_F(TaskTableTest, ANumberThatIsAnothersAlreadyStaysTheOthers) {
  Task& first = table_.AddTask(10);
  Task& second = table_.AddTask(10);
  table_.TaskEnded(first);
  EXPECT_EQ(table_.Living(10), &second);
  EXPECT_EQ(table_.living(), 1);
}

TEST_F(TaskTableTest, AProcesssMainThreadComesFirstWhereverItsPlaceIs) {
  Process& process = table_.AddProcess(10);
  Process& other = table_.AddProcess(20);
  table_.TaskEnded(table_.AddTask(1));
  for (const pid_t tid : {11, 20, 12, 13}) {
    table_.AddTask(tid).process = tid == 20 ? &other : &process;
  }
  table_.Living(13)->state = TaskState::kDead;
  // So many have ended that the first place is had again.
  PassThreads(static_cast<int>(TaskTable::kKeptAfterEnd));
  table_.AddTask(14).process = &process;
  Task& main = table_.AddTask(10);
  main.process = &process;
  ASSERT_LT(table_.Living(14)->order, table_.Living(11)->order);
  ASSERT_GT(main.order, table_.Living(14)->order);
  std::vector<pid_t> tids;
  for (const Task* task : table_.ThreadsOf(process)) tids.push_back(task->tid);
  EXPECT_EQ(tids, (std::vector<pid_t>{10, 14, 11, 12}));
}

TEST_F(TaskTableTest, WhoHasJustEndedKeepsItsPlace) {
  Task& task = table_.AddTask(10);
  table_.TaskEnded(task);
  PassThreads(static_cast<int>(TaskTable::kKeptAfterEnd));
  EXPECT_EQ(task.tid, 10);
}

TEST_F(TaskTableTest, APlaceIsHadAgainAsNew) {
  Task& task = table_.AddTask(10);
  task.charged = VirtualNs(5);
  table_.TaskEnded(task);
  PassThreads(static_cast<int>(TaskTable::kKeptAfterEnd));
  EXPECT_EQ(&table_.AddTask(11), &task);
  EXPECT_EQ(task.tid, 11);
  EXPECT_EQ(task.order, 0);
  EXPECT_EQ(task.charged, VirtualDuration());
}

TEST_F(TaskTableTest, ThousandsThatComeAndGoTakeNoMoreRoom) {
  PassThreads(10'000);
  PassProcesses(10'000);
  EXPECT_LE(table_.tasks().size(), TaskTable::kKeptAfterEnd + 1);
  EXPECT_LE(table_.processes().size(), TaskTable::kKeptAfterEnd + 1);
}

TEST_F(TaskTableTest, AProcessThatNobodyHasReapedKeepsItsPlace) {
  unreaped_ = {10};
  Process& process = table_.AddProcess(10);
  End(process);
  PassProcesses(1000);
  EXPECT_EQ(process.pid, 10);
  unreaped_.clear();
  PassProcesses(1000);
  EXPECT_NE(process.pid, 10);
}

TEST_F(TaskTableTest, APlaceThatIsNotGivenUpIsNobodyElses) {
  Process& client = table_.AddProcess(10);
  table_.ProcessEnded(client);
  PassProcesses(1000);
  EXPECT_EQ(client.pid, 10);
}

}  // namespace
}  // namespace tcs

// Tells the book of answers (answers/answer_book.h) of a run's threads: whose they are. A run
// without a folder for its results keeps none.
//
// For the coordinator's thread only.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "coordinator/answers/answer_book.h"
#include "coordinator/answers/chain_book.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class AnswerFeed {
 public:
  // The scenario is the one that processes' specifications belong to, and outlives this.
  void Open(const Scenario& scenario);
  bool is_open() const { return !clients_.empty(); }
  // Clients' names, by their numbers in the book.
  std::vector<std::string> NamesOfClients() const;

  // Whether the client is tcsim's own, of which results do not tell.
  bool IsOurs(int client) const { return ours_ >= 0 && client >= ours_; }

  // None for a thread that is no client's.
  std::optional<AnswerBook::Who> WhoIs(const Task& task) const;
  // The same for a client's first thread, without a number. By the client's name: ROBOT/CLIENT.
  std::optional<AnswerBook::Who> WhoIs(const std::string& client) const;
  std::optional<AnswerBook::Who> WhoIs(const ClientSpec& client) const;
  // The thread's number may be another thread's from now on.
  void Dies(const Task& task);
  AnswerBook& book() { return book_; }
  ChainBook& chains() { return chains_; }
  static ChainBook::Who OnChain(const AnswerBook::Who& who) { return {who.thread, who.client}; }
  const AnswerBook& book() const { return book_; }

 private:
  void OpenChains(const Scenario& scenario);

  // The client that had a thread when it was last asked for, which happens several times in each of
  // the thread's turns.
  struct Known {
    const Process* process = nullptr;  // null: no client's, as far as is known
    int client = 0;
  };
  AnswerBook book_;
  ChainBook chains_;
  std::unordered_map<const ClientSpec*, int> clients_;
  std::map<std::string, int> names_;
  // The gateway's first number, the last but one of all: the gateway's commands are not made of
  // what it knows of sensors, so it counts as two. -1: there is no gateway.
  int ours_ = -1;
  mutable std::vector<Known> known_;  // by thread, as AnswerBook::Who has it
};

}  // namespace tcs

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

  // None of a thread that is no client's.
  std::optional<AnswerBook::Who> WhoIs(const Task& task) const;
  // Of a client's first thread, without a number. By its name: ROBOT/CLIENT.
  std::optional<AnswerBook::Who> WhoIs(const std::string& client) const;
  std::optional<AnswerBook::Who> WhoIs(const ClientSpec& client) const;
  // Its number may be another thread's from now on.
  void Dies(const Task& task);
  AnswerBook& book() { return book_; }
  ChainBook& chains() { return chains_; }
  static ChainBook::Who OnChain(const AnswerBook::Who& who) { return {who.thread, who.client}; }
  const AnswerBook& book() const { return book_; }

 private:
  void OpenChains(const Scenario& scenario);

  // Whose a thread was when it was last asked for, which it is several times in each of its turns.
  struct Known {
    const Process* process = nullptr;  // null: nobody's, as far as is known
    int client = 0;
  };
  AnswerBook book_;
  ChainBook chains_;
  std::unordered_map<const ClientSpec*, int> clients_;
  std::map<std::string, int> names_;
  // The gateway's first number, the last but one of all: what it knows of sensors is not what its
  // commands are made of, so it counts as two. None: there is no gateway.
  int ours_ = -1;
  mutable std::vector<Known> known_;  // by thread, as AnswerBook::Who has it
};

}  // namespace tcs

#include "coordinator/expect/expect_json.h"

#include <cmath>

namespace tcs {

namespace {

nlohmann::ordered_json NumberOrNull(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

}  // namespace

nlohmann::ordered_json ExpectationsJson(const std::vector<Judgement>& judgements) {
  auto all = nlohmann::ordered_json::array();
  for (const Judgement& judgement : judgements) {
    const ExpectationSpec& expected = judgement.expected;
    nlohmann::ordered_json one{{"subject", expected.subject},
                               {"figure", expected.figure},
                               {"least", NumberOrNull(expected.least)},
                               {"most", NumberOrNull(expected.most)},
                               {"share", expected.share},
                               {"holds", judgement.holds},
                               {"value", NumberOrNull(judgement.value.value_or(NAN))}};
    if (expected.kept) one["largest"] = NumberOrNull(judgement.largest.value_or(NAN));
    one["first_time_ns"] = judgement.first_time_ns;
    one["what"] = judgement.what;
    one["place"] = expected.place;
    all.push_back(std::move(one));
  }
  return all;
}

std::vector<Judgement> ExpectationsFromSummary(const std::string& text) {
  std::vector<Judgement> judgements;
  try {
    const auto json = nlohmann::json::parse(text);
    for (const auto& one : json.value("expectations", nlohmann::json::array())) {
      Judgement judgement;
      one.at("subject").get_to(judgement.expected.subject);
      one.at("figure").get_to(judgement.expected.figure);
      one.at("share").get_to(judgement.expected.share);
      one.at("place").get_to(judgement.expected.place);
      one.at("holds").get_to(judgement.holds);
      one.at("first_time_ns").get_to(judgement.first_time_ns);
      one.at("what").get_to(judgement.what);
      judgements.push_back(std::move(judgement));
    }
  } catch (const nlohmann::json::exception&) {
    return {};
  }
  return judgements;
}

}  // namespace tcs

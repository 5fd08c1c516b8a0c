#include <CLI/CLI.hpp>

#include "coordinator/cli/compare_command.h"

namespace tcs {

const CLI::App* AddCompare(CLI::App* app, CompareArguments* arguments) {
  CLI::App* compare = app->add_subcommand(
      "compare",
      "what became worse from one run, or set of trials, to another, and whether by chance");
  compare
      ->add_option("before", arguments->before, "FOLDER: what `tcsim run` or `tcsim trials` wrote")
      ->required();
  compare->add_option("after", arguments->after, "FOLDER: the same of what is judged")->required();
  compare
      ->add_option("--tolerance", arguments->tolerance,
                   "SHARE: by how much a figure may be worse, such as 5% of what it was")
      ->capture_default_str();
  compare
      ->add_option("--confidence", arguments->confidence,
                   "SHARE: how seldom chance may be called a change: with 99%, in one of 100 "
                   "comparisons of equal sets")
      ->capture_default_str();
  compare
      ->add_option("--measure", arguments->measures,
                   "NAME: compare only this figure, such as controller.misses, or all of a client "
                   "or metric; repeatable (default: misses, response and execution times, ages, "
                   "lost samples, metrics)")
      ->allow_extra_args(false);
  compare
      ->add_option("--more-is-better", arguments->more_is_better,
                   "NAME: a metric of which less is worse; repeatable (default: any change of a "
                   "metric counts)")
      ->allow_extra_args(false);
  compare
      ->add_option("--less-is-better", arguments->less_is_better,
                   "NAME: a metric of which more is worse; repeatable")
      ->allow_extra_args(false);
  compare->add_flag("--json", arguments->as_json, "for programs (docs/TRIALS.md)");
  return compare;
}

}  // namespace tcs

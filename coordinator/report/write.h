// The page and its figures on the disk.
#pragma once

#include <string>

#include "coordinator/report/page.h"

namespace tcs::report {

enum class FigureFiles { kNone, kSvg, kPng };

// Writes the page to `path` and, where wanted, its figures next to it: OUT-distances.svg and so on
// for OUT.html. PNGs are made by rsvg-convert. Empty on success, else one sentence; `written` gets
// the names of the files that were written.
[[nodiscard]] std::string WritePage(const Page& page, const std::string& path, FigureFiles figures,
                                    std::vector<std::string>* written);

}  // namespace tcs::report

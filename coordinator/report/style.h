// The colours of figures and page, in the light and in the dark. Series have classes: lines "s0" …
// "s7", areas "f0" …, texts "t0" …
#pragma once

#include <string>

namespace tcs::report {

inline constexpr int kSeriesColours = 8;

// The rules for figures with the colours of the light, for a picture that stands alone.
[[nodiscard]] std::string StandaloneStyle();

// Variables with the colours, for the light and for the dark, and the same rules made of them.
[[nodiscard]] std::string PageStyle();

// "s3", and so on; further series begin again with the first colour.
[[nodiscard]] std::string SeriesClass(char kind, int series);

}  // namespace tcs::report

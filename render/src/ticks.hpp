// Round numbers for axes and colour bars, and how to write numbers.
//
// Errors   none: an empty or non-finite range gives no ticks
#pragma once

#include <span>
#include <string>
#include <vector>

namespace render {

struct Ticks {
  std::vector<double> at;           // inside of the range, rising
  std::vector<std::string> labels;  // of each, in units of 10^exponent
  std::vector<double> minor;        // logarithmic: without labels, in between
  int exponent = 0;                 // not 0 where the numbers would be long
};

// Steps of 1, 2 or 5 times a power of ten, at most `most` ticks; where that leaves fewer than the two that
// make a scale (and `most` > 1), smaller steps, with at most two ticks more than asked for.
Ticks linear_ticks(double low, double high, int most);

// Powers of ten in [low, high] > 0, labelled "10^k" (for typeset()), thinned out to at most `most`; where the
// range has fewer than two of them, also 2 and 5 times.
Ticks log_ticks(double low, double high, int most);

// "10 Pa", "2.5 kPa": three significant digits and a prefix.
std::string with_unit(double value, const std::string& unit);

// "t = 0.517 s".
std::string time_text(double seconds);
// In the unit of the longest of the times that it is read beside.
std::string time_text(double seconds, double longest);

// "0.25 s": all in one unit, with as many decimals as tell each from its rounded value: up to three, from
// 100 on two, from 1000 on one.
std::vector<std::string> short_times(std::span<const double> seconds);

}  // namespace render

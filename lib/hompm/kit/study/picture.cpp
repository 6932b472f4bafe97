#include <algorithm>
#include <array>
#include <charconv>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hompm/kit/study/answers.hpp>
#include <hompm/number.hpp>

namespace hompm::study {
namespace {

/// Okabe and Ito's colours, which everybody can tell apart, and shapes that differ, too; in the order in
/// which schemes appear. A colour that comes again is dashed.
struct Style {
  const char* colour;
  const char* shape;
  const char* dash;
};
constexpr std::array<Style, 16> styles{{{"#D55E00", "7", "1"},
                                        {"#0072B2", "5", "1"},
                                        {"#009E73", "9", "1"},
                                        {"#CC79A7", "13", "1"},
                                        {"#E69F00", "11", "1"},
                                        {"#56B4E9", "15", "1"},
                                        {"#000000", "6", "1"},
                                        {"#999999", "4", "1"},
                                        {"#D55E00", "8", "2"},
                                        {"#0072B2", "12", "2"},
                                        {"#009E73", "10", "2"},
                                        {"#CC79A7", "14", "2"},
                                        {"#E69F00", "1", "2"},
                                        {"#56B4E9", "3", "2"},
                                        {"#000000", "2", "2"},
                                        {"#999999", "7", "2"}}};

struct Ranges {
  double least_cost = std::numeric_limits<double>::infinity();
  double most_cost = 0.0;
  double least_error = std::numeric_limits<double>::infinity();
  double most_error = 0.0;
};

/// n of value = m · 10ⁿ, 1 ≤ m < 10.
int decade_of(double value) {
  std::array<char, 32> text{};
  const char* const end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific).ptr;
  const char* const e = std::find(text.begin(), text.end(), 'e');
  int decade = 0;
  std::from_chars(e + (e[1] == '+' ? 2 : 1), end, decade);
  return decade;
}

double power_of_ten(int n) {
  const std::string text = "1e" + std::to_string(n);
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

Ranges ranges_of(const std::vector<Outcome>& outcomes, Cost cost) {
  Ranges ranges;
  for (const Field field : all_fields)
    for (const auto& [price, error] : choice_of(outcomes, field, cost).candidates) {
      if (!(price > 0.0 && error > 0.0)) continue;
      ranges.least_cost = std::min(ranges.least_cost, price);
      ranges.most_cost = std::max(ranges.most_cost, price);
      ranges.least_error = std::min(ranges.least_error, error);
      ranges.most_error = std::max(ranges.most_error, error);
    }
  if (ranges.most_cost == 0.0) ranges = {1.0, 10.0, 1e-3, 1.0};  // nothing but failures
  return {power_of_ten(decade_of(ranges.least_cost)), power_of_ten(decade_of(ranges.most_cost) + 1),
          power_of_ten(decade_of(ranges.least_error)), power_of_ten(decade_of(ranges.most_error) + 1)};
}

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

std::string block(const std::string& name, const std::vector<Candidate>& rows) {
  std::string text = "$" + name + " << EOD\n";
  for (const auto& [cost, error] : rows) text += to_text(cost) + " " + to_text(error) + "\n";
  return text + "EOD\n";
}

std::vector<Candidate> picked(const Choice& choice, const std::vector<std::size_t>& which) {
  std::vector<Candidate> rows;
  rows.reserve(which.size());
  for (const std::size_t i : which) rows.push_back(choice.candidates[i]);
  return rows;
}

/// Failed points of a scheme at the upper edge.
std::vector<Candidate> failures(const std::vector<Outcome>& outcomes, const std::string& scheme, Cost cost,
                                const Ranges& ranges) {
  std::vector<Candidate> rows;
  for (const Outcome& outcome : outcomes)
    if (outcome.record.scheme == scheme && outcome.record.status != Status::ok)
      rows.push_back({std::clamp(cost_of(outcome, cost).value_or(0.0), ranges.least_cost, ranges.most_cost),
                      ranges.most_error});
  return rows;
}

double floor_of(const std::vector<Outcome>& outcomes, Field field) {
  double highest = 0.0;
  for (const Outcome& outcome : outcomes)
    if (const auto error = error_of(outcome, field)) highest = std::max(highest, error->reference);
  return highest;
}

std::string panel(const std::vector<Outcome>& outcomes, Field field, Cost cost, const Ranges& ranges) {
  const Choice all = choice_of(outcomes, field, cost);
  std::string data = block("best", picked(all, pareto_front(all.candidates)));
  std::vector<std::string> curves{
      "$best using 1:2 with lines linewidth 9 linecolor \"#DDDDDD\" title \"best of all\""};
  std::size_t number = 0;
  for (const std::string& scheme : schemes_in(outcomes)) {
    const auto& [colour, shape, dash] = styles[number % styles.size()];
    const std::string id = std::to_string(number++);
    const Choice part = of_scheme(all, scheme);
    const auto failed = failures(outcomes, scheme, cost, ranges);
    const std::string ink = joined({" linecolor \"", colour, "\""});
    data += block("dots" + id, part.candidates);
    data += block("front" + id, picked(part, pareto_front(part.candidates)));
    data += block("failed" + id, failed);
    if (!part.candidates.empty()) {
      curves.push_back(
          joined({"$dots", id, " using 1:2 with points pointtype 7 pointsize 0.25", ink, " notitle"}));
      curves.push_back(joined({"$front", id, " using 1:2 with linespoints linewidth 2 dashtype ", dash,
                               " pointsize 0.7 pointtype ", shape, ink, " title \"", scheme, "\""}));
    }
    if (!failed.empty())
      curves.push_back(joined(
          {"$failed", id, " using 1:2 with points pointtype 2 pointsize 0.8 linewidth 2", ink, " notitle"}));
  }
  if (const double own = floor_of(outcomes, field); own > ranges.least_error)
    curves.push_back(
        to_text(own) +
        " with lines linewidth 1.5 dashtype 2 linecolor \"#606060\" title \"reference's own error\"");
  std::string text = data + "set title \"" + to_string(field) + "\" offset 0,-0.5\nplot ";
  for (std::size_t i = 0; i < curves.size(); ++i) text += (i > 0 ? ", \\\n     " : "") + curves[i];
  return text + "\n";
}

}  // namespace

std::string picture_script(const std::vector<Outcome>& outcomes, Cost cost, const std::string& title,
                           const std::string& name) {
  const Ranges ranges = ranges_of(outcomes, cost);
  std::string panels;
  for (const Field field : all_fields) {
    panels += field == all_fields.front() ? "set ylabel \"relative L2 error\"\n" : "set ylabel \"\"\n";
    panels += field == all_fields.back()
                  ? "set key at screen 0.995,0.87 right top Left reverse samplen 3 spacing 0.95\n"
                  : "unset key\n";
    panels += panel(outcomes, field, cost, ranges);
  }
  std::string text =
      "set encoding utf8\nset tics nomirror\nset border 3 linecolor \"#404040\"\n"
      "set grid linecolor \"#E0E0E0\" linetype 1\nset logscale xy 10\n"
      "set format xy \"10^{%T}\"\n";
  text += "set xrange [" + to_text(ranges.least_cost) + ":" + to_text(ranges.most_cost) + "]\nset yrange [" +
          to_text(ranges.least_error) + ":" + to_text(ranges.most_error) + "]\nset xlabel \"" +
          to_string(cost) + "\"\n";
  std::string plain = title;  // in quotes
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '"' || c == '\\'; }, ' ');
  for (const auto& [terminal, ending] :
       {std::pair{"svg size 1380,500 font \"Helvetica,15\" background \"#FFFFFF\"", "svg"},
        std::pair{"pngcairo size 1380,500 font \"Helvetica,11\" background \"#FFFFFF\"", "png"}})
    text += joined({"set terminal ", terminal, "\nset output \"", name, ".", ending,
                    "\"\nset multiplot layout 1,3 margins 0.055,0.85,0.13,0.87 spacing 0.04 title \"", plain,
                    "\" font \",17\" noenhanced offset 0,-0.2\n", panels, "unset multiplot\nset output\n"});
  return text;
}

}  // namespace hompm::study

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <utility>

#include <hompm/kit/scene_file/value_rule.hpp>
#include <hompm/kit/study/answers.hpp>

namespace hompm::study {
namespace {

double least_error(const Choice& choice) {
  const auto least = std::min_element(choice.candidates.begin(), choice.candidates.end(),
                                      [](const auto& a, const auto& b) { return a.error < b.error; });
  return least->error;
}

std::string what_others_need(const Choice& scheme, const std::string& name, double error, double cost) {
  const std::string who = "`" + name + "`";
  if (scheme.candidates.empty()) return who + " never ran";
  if (const auto best = cheapest(scheme.candidates, error))
    return who + " needs " + brief(scheme.candidates[*best].cost / cost) + " ×";
  return who + " does not get there in this sweep (best " + brief(least_error(scheme)) + ")";
}

}  // namespace

std::string brief(double value) {
  std::array<char, 32> text{};
  const bool plain = value == 0.0 || (value >= 0.095 && value < 9995.0);
  if (plain)
    std::snprintf(text.data(), text.size(), value < 9.95 ? "%.1f" : "%.0f", value);
  else
    std::snprintf(text.data(), text.size(), "%.1e", value);
  std::string short_text = text.data();
  // 1.0e-04 → 1e-4
  if (const auto zero = short_text.find(".0"); zero != std::string::npos && zero + 2 <= short_text.size() &&
                                               (zero + 2 == short_text.size() || short_text[zero + 2] == 'e'))
    short_text.erase(zero, 2);
  if (const auto e = short_text.find('e'); e != std::string::npos) {
    if (short_text[e + 1] == '+') short_text.erase(e + 1, 1);
    const auto digits = short_text.find_first_of("0123456789", e);
    if (short_text[digits] == '0' && digits + 1 < short_text.size()) short_text.erase(digits, 1);
  }
  return short_text;
}

std::string setting_text(const Outcome& outcome) {
  const Record& record = outcome.record;
  std::string text = "`" + record.scheme + "` p = " + std::to_string(record.degree) + ", " +
                     std::to_string(record.cells) + " cells × " + std::to_string(record.particles_per_cell);
  for (const auto& [key, value, where] : outcome.point.settings) {
    const std::string name = short_key(key);
    if (name == "scheme" || name == "degree" || name == "cells" || name == "particles_per_cell") continue;
    text.append(", ").append(name).append(" ").append(value);
  }
  return text;
}

std::string command_text(const Study& study, const Outcome& outcome) {
  std::string text = "hompm-run ";
  text += study.scene_file.empty() ? "--case " + study.case_name : "--scene " + study.scene_file;
  if (!study.variant.empty()) text += " --variant " + study.variant;
  for (const auto* list : {&study.settings, &outcome.point.settings})
    for (const auto& [key, value, where] : *list)
      text.append(" --set ").append(key).append("=").append(value);
  return text;
}

std::string answer(const std::vector<Outcome>& outcomes, Field field, Cost cost, double error) {
  const Choice all = choice_of(outcomes, field, cost);
  const std::string start = "error " + brief(error) + " in " + to_string(field) + ": ";
  if (all.candidates.empty()) return start + "nothing was measured";
  const auto best = cheapest(all.candidates, error);
  if (!best) return start + "nothing gets there; the best is " + brief(least_error(all));
  const Outcome& winner = *all.outcomes[*best];
  const double price = all.candidates[*best].cost;
  std::string text =
      start + "cheapest is " + setting_text(winner) + ": " + brief(price) + " " + to_string(cost);
  if (const auto seconds = cost_of(winner, Cost::seconds); seconds && cost != Cost::seconds)
    text += ", " + brief(*seconds * 1e3) + " ms";
  std::string others;
  for (const std::string& name : schemes_in(outcomes))
    if (name != winner.record.scheme)
      others += (others.empty() ? "; " : ", ") + what_others_need(of_scheme(all, name), name, error, price);
  return text + others;
}

std::string answers(const std::vector<Outcome>& outcomes, Cost cost) {
  std::string text;
  for (const Field field : all_fields) {
    const Choice all = choice_of(outcomes, field, cost);
    if (all.candidates.empty()) continue;
    const double least = least_error(all);
    static constexpr std::array<double, 14> decades{1e-1, 1e-2, 1e-3,  1e-4,  1e-5,  1e-6,  1e-7,
                                                    1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14};
    for (const double error : decades)
      if (error >= least) text += answer(outcomes, field, cost, error) + "\n";
  }
  return text;
}

std::string remarks(const std::vector<Outcome>& outcomes) {
  std::string text;
  std::map<std::pair<Status, std::string>, int> failed;
  const Outcome* judged = nullptr;
  double own = 0.0;
  for (const Outcome& outcome : outcomes) {
    const Record& record = outcome.record;
    if (record.status != Status::ok)
      ++failed[{record.status, record.reason.substr(0, record.reason.find('\n'))}];
    if (!outcome.record.errors) continue;
    judged = &outcome;
    own = std::max(own, outcome.record.errors->reference_errors.displacement);
  }
  if (judged != nullptr)
    text += "reference: " + judged->record.errors->reference + "; its own error in displacement is " +
            (own > 0.0 ? brief(own) : std::string("that of rounding")) + "\n";
  constexpr std::size_t most_reasons = 20;
  std::size_t told = 0;
  for (const auto& [why, count] : failed) {
    if (++told > most_reasons) break;
    text += std::to_string(count) + " of " + std::to_string(outcomes.size()) +
            " points: " + to_string(why.first) + ": " + why.second + "\n";
  }
  if (failed.size() > most_reasons)
    text += "and " + std::to_string(failed.size() - most_reasons) + " more reasons, in points.csv\n";
  return text;
}

}  // namespace hompm::study

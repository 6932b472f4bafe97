#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/kit/study/answers.hpp>
#include <hompm/number.hpp>

namespace hompm::study {
namespace {

using Json = nlohmann::ordered_json;

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? "\"\"" : c == '\n' ? "; " : std::string(1, c);
  return cell + "\"";
}

/// The name of a field's column is field_norm.
constexpr std::array<std::pair<const char*, double ErrorNorms::*>, 3> norms{
    {{"relative_l2", &ErrorNorms::relative_l2}, {"rms", &ErrorNorms::rms}, {"max", &ErrorNorms::max}}};

class Row {
 public:
  Row& operator<<(const std::string& cell) {
    text_ += (text_.empty() ? "" : ",") + cell;
    return *this;
  }
  Row& operator<<(double value) { return *this << to_text(value); }
  Row& operator<<(std::int64_t value) { return *this << std::to_string(value); }
  Row& operator<<(std::uint64_t value) { return *this << std::to_string(value); }
  Row& operator<<(int value) { return *this << std::to_string(value); }
  [[nodiscard]] std::string line() const { return text_ + "\n"; }

 private:
  std::string text_;
};

}  // namespace

std::string points_csv(const std::vector<Outcome>& outcomes) {
  Row header;
  header << "point,status,reason,scheme,degree,cells,particles_per_cell,particles,time_step,steps";
  for (const Field field : all_fields) {
    for (const auto& [norm, value] : norms) header << to_string(field) + "_" + norm;
    header << to_string(field) + "_reference_error";
  }
  header
      << "particle_steps,force_evaluations,mass_solves,bytes,instructions,instructions_per_particle_and_step";
  std::string text = header.line();
  for (const Outcome& outcome : outcomes) {
    const Record& record = outcome.record;
    const Work& work = record.work;
    Row row;
    row << quoted(record.name) << to_string(record.status) << quoted(record.reason) << record.scheme
        << record.degree << record.cells << record.particles_per_cell << work.particles << record.time_step
        << work.steps;
    for (const Field field : all_fields) {
      const auto error = error_of(outcome, field);
      for (const auto& [norm, value] : norms) row << (error ? to_text(error->norms.*value) : std::string());
      row << (error ? to_text(error->reference) : std::string());
    }
    row << work.particle_steps() << work.force_evaluations << work.mass_solves << work.bytes;
    const auto& count = record.instructions;
    row << (count ? std::to_string(count->total) : std::string())
        << (count ? to_text(count->per_particle_and_step) : std::string());
    text += row.line();
  }
  return text;
}

std::string times_csv(const std::vector<Outcome>& outcomes) {
  std::string text = "point,runs,least,median,largest,nanoseconds_per_particle_and_step\n";
  for (const Outcome& outcome : outcomes) {
    if (outcome.seconds.empty()) continue;
    std::vector<double> sorted = outcome.seconds;
    std::sort(sorted.begin(), sorted.end());
    const auto particle_steps = static_cast<double>(outcome.record.work.particle_steps());
    Row row;
    row << quoted(outcome.record.name) << std::uint64_t{sorted.size()} << sorted.front()
        << sorted[sorted.size() / 2] << sorted.back() << sorted.front() * 1e9 / particle_steps;
    text += row.line();
  }
  return text;
}

Cost steady_cost(const std::vector<Outcome>& outcomes) {
  const bool counted = std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& outcome) {
    return outcome.record.status != Status::ok || outcome.record.instructions.has_value();
  });
  return counted ? Cost::instructions : Cost::particle_steps;
}

std::string study_json(const Study& study, const std::vector<Outcome>& outcomes) {
  const Cost cost = steady_cost(outcomes);
  Json json{{"case", study.case_name}, {"variant", study.variant}, {"scene", study.scene_file}};
  for (const auto& [key, value, where] : study.settings) json["set"][key] = value;
  for (const Field field : all_fields) {
    const Choice choice = choice_of(outcomes, field, cost);
    Json front = Json::array();
    for (const std::size_t i : pareto_front(choice.candidates))
      front.push_back({{"point", choice.outcomes[i]->record.name},
                       {to_string(cost), choice.candidates[i].cost},
                       {"error", choice.candidates[i].error}});
    json["front"][to_string(field)] = front;
  }
  for (const Outcome& outcome : outcomes) {
    Json point = Json::parse(record_text(outcome.record));
    point.erase("program");
    point.erase("scene");
    for (const auto& [key, value, where] : outcome.point.settings) point["settings"][key] = value;
    json["points"].push_back(point);
  }
  return json.dump(2) + "\n";
}

}  // namespace hompm::study

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/study/measure.hpp>
#include <hompm/kit/study/outcome.hpp>

namespace hompm::study {

std::vector<std::size_t> pareto_front(std::span<const Candidate> candidates) {
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(candidates[a].cost, candidates[a].error) <
           std::tuple(candidates[b].cost, candidates[b].error);
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || candidates[i].error < candidates[front.back()].error) front.push_back(i);
  return front;
}

std::optional<std::size_t> cheapest(std::span<const Candidate> candidates, double error) {
  for (const std::size_t i : pareto_front(candidates))
    if (candidates[i].error <= error) return i;
  return std::nullopt;
}

std::string to_string(Field field) {
  return std::array{"displacement", "velocity", "stress"}[static_cast<std::size_t>(field)];
}

std::string to_string(Cost cost) {
  return std::array{"instructions", "seconds", "particle steps"}[static_cast<std::size_t>(cost)];
}

std::optional<FieldError> error_of(const Outcome& outcome, Field field) {
  if (!outcome.record.errors) return std::nullopt;
  const ErrorReport& errors = *outcome.record.errors;
  const ErrorField& row = error_fields[static_cast<std::size_t>(field)];
  return FieldError{errors.*row.norms, errors.reference_errors.*row.error};
}

std::optional<double> cost_of(const Outcome& outcome, Cost cost) {
  if (cost == Cost::instructions) {
    if (!outcome.record.instructions) return std::nullopt;
    return static_cast<double>(outcome.record.instructions->total);
  }
  if (cost == Cost::particle_steps) return static_cast<double>(outcome.record.work.particle_steps());
  if (outcome.seconds.empty()) return std::nullopt;
  return *std::min_element(outcome.seconds.begin(), outcome.seconds.end());
}

Choice choice_of(const std::vector<Outcome>& outcomes, Field field, Cost cost) {
  Choice choice;
  for (const Outcome& outcome : outcomes) {
    const auto error = error_of(outcome, field);
    const auto price = cost_of(outcome, cost);
    if (!error || !price) continue;
    choice.outcomes.push_back(&outcome);
    choice.candidates.push_back({*price, error->norms.relative_l2});
  }
  return choice;
}

Choice of_scheme(const Choice& choice, const std::string& scheme) {
  Choice part;
  for (std::size_t i = 0; i < choice.outcomes.size(); ++i) {
    if (choice.outcomes[i]->record.scheme != scheme) continue;
    part.outcomes.push_back(choice.outcomes[i]);
    part.candidates.push_back(choice.candidates[i]);
  }
  return part;
}

std::vector<std::string> schemes_in(const std::vector<Outcome>& outcomes) {
  std::vector<std::string> names;
  for (const Outcome& outcome : outcomes)
    if (!outcome.record.scheme.empty() &&
        std::find(names.begin(), names.end(), outcome.record.scheme) == names.end())
      names.push_back(outcome.record.scheme);
  return names;
}

bool is_current(const Study& study, const Point& point, const Record& record, const std::string& program) {
  if (record.program != program) return false;
  try {
    return record.scene == scene_text(measured_scene(study, point));
  } catch (const SceneError& error) {
    return record.status == Status::refused && record.reason == error.what();
  }
}

Gathered gather(const Study& study, const std::vector<Point>& points, const std::filesystem::path& folder,
                const std::string& program) {
  Gathered gathered;
  for (const Point& point : points) {
    const auto text = text_of(record_path(folder, point.name));
    if (!text) {
      gathered.missing.push_back(point.name);
      continue;
    }
    Record record = read_record(*text);
    if (!is_current(study, point, record, program)) {
      gathered.missing.push_back(point.name);
      continue;
    }
    Outcome outcome{point, std::move(record), {}};
    if (const auto taken = text_of(times_path(folder, point.name))) {
      Times times = read_times(*taken);
      if (times.program == program && times.scene == outcome.record.scene)
        outcome.seconds = std::move(times.seconds);
    }
    gathered.outcomes.push_back(std::move(outcome));
  }
  return gathered;
}

}  // namespace hompm::study

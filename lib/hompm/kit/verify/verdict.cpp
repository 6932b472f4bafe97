#include <algorithm>
#include <array>
#include <charconv>

#include <hompm/kit/verify/verdict.hpp>

namespace hompm {
namespace {

constexpr double good_enough = 0.05;
constexpr double too_bad = 0.2;

/// Two digits: "228 %", "2.3 %", "0.1 %", "3.1e-06".
std::string part_text(double part) {
  std::array<char, 32> digits{};
  const bool percent = part >= 1e-3 && part < 100.0;
  const bool whole = percent && part >= 0.0995;
  const auto end = std::to_chars(digits.begin(), digits.end(), percent ? 100.0 * part : part,
                                 whole ? std::chars_format::fixed : std::chars_format::general, whole ? 0 : 2)
                       .ptr;
  return std::string(digits.begin(), end) + (percent ? " %" : "");
}

/// The first of what can be told, the surest first.
Cause cause_of(const Scene& scene, const RunResult& result, const ErrorReport& errors,
               const RunMotion& motion) {
  const SchemeChoices& choices = scene.scheme.choices;
  const bool high = scene.scheme.name == "high-order";
  const std::string more_cells =
      "--cells " + std::to_string(2 * scene.scheme.cells) + " (four times the cost)";
  const std::string another = high ? more_cells : "--scheme high-order (two to five times the cost)";
  const bool hats = scene.scheme.degree == 1 && choices.basis == Basis::splines &&
                    choices.quadrature == Quadrature::particles;
  const bool moves =
      scene.kinematics == Kinematics::finite && choices.formulation == Formulation::updated_lagrangian;
  if (result.largest_step_fraction > 1.0)
    return {"time-step", "the time step was above the critical one", "--step-fraction 0.5"};
  if (hats && moves && motion.crossings > 0)
    return {"grid-crossing", "particles crossed cells with hat functions",
            "--scheme bspline (at about the same cost), or " + another};
  if (errors.jump)
    return {"jump", "the stress has a jump, at which errors fall with the root of the cell size at best",
            (scene.material.law == "linear" ? "" : "the effect bulk-viscosity, and ") + more_cells};
  constexpr double enough_cells = 4.0;
  if (errors.cells_per_wave < enough_cells)
    return {"resolution", "there are fewer than four cells for a half wave of the stress", more_cells};
  if (errors.kink)
    return {"kink", "the stress has a kink, at which the order of a scheme is lost", more_cells};
  if (moves && motion.crossings > 0 && !reconstructs(choices.quadrature))
    return {"quadrature",
            "the particles are no good points of quadrature once they have moved through the grid", another};
  if (constexpr double of_energy = 0.05; result.largest_residual > of_energy * result.largest_energy)
    return {"energy",
            "the energy balance is off by " + part_text(result.largest_residual / result.largest_energy),
            another};
  return {"", "the cause was not found", high ? more_cells : another + ", or " + more_cells};
}

}  // namespace

const char* to_string(VerdictLevel level) {
  constexpr std::array names{"good", "doubtful", "bad", "unknown"};
  return names[static_cast<std::size_t>(level)];
}

const char* to_string(ErrorKind kind) {
  constexpr std::array names{"exact", "computed", "extrapolated"};
  return names[static_cast<std::size_t>(kind)];
}

RunVerdict verdict_of(const Scene& scene, const RunResult& result, const std::optional<ErrorReport>& errors,
                      const std::string& reason, const RunMotion& motion) {
  if (!errors) return {VerdictLevel::unknown, "not known: " + reason, {}};
  const ErrorField* worst = error_fields.data();
  const auto bound = [&](const ErrorField* field) { return errors->bound.*field->error; };
  for (const ErrorField& field : error_fields)
    if (!(bound(&field) <= bound(worst))) worst = &field;
  const double most = bound(worst);
  const double own = errors->reference_errors.*worst->error;
  const std::string name(worst->name);
  const std::string against = "against " + errors->reference +
                              (errors->kind == ErrorKind::exact ? "" : ", good to " + part_text(own));
  if (most <= good_enough)
    return {VerdictLevel::good, "good to " + part_text(most) + " in " + name + " (" + against + ")", {}};
  if (most > too_bad && own > 0.5 * most)
    return {VerdictLevel::unknown,
            "not known: " + name + " may be wrong by " + part_text(most) + ", but the reference (" +
                errors->reference + ") is only good to " + part_text(own) +
                " in it; --errors full spends more on it",
            {}};
  const bool bad = !(most <= too_bad);
  const Cause cause = cause_of(scene, result, *errors, motion);
  return {bad ? VerdictLevel::bad : VerdictLevel::doubtful,
          (bad ? "bad: " : "doubtful: ") + name + " wrong by " + part_text(most) + ": " + cause.text +
              "; take " + cause.cure + " (" + against + ")",
          cause};
}

std::string unmet(const Scene& scene, const std::optional<ErrorReport>& errors, const RunVerdict& verdict) {
  std::string text;
  for (const ErrorField& field : error_fields) {
    const std::optional<double> asked = scene.require.*field.required;
    if (!asked || (errors && errors->bound.*field.error <= *asked)) continue;
    text +=
        std::string(field.name) + " is to be good to " + part_text(*asked) + ", and is " +
        (errors ? "good to " + part_text(errors->bound.*field.error) : std::string("not known")) + ": " +
        (verdict.level == VerdictLevel::good ? std::string("more cells, or --scheme high-order, come nearer")
                                             : verdict.text) +
        "\n";
  }
  return text;
}

}  // namespace hompm

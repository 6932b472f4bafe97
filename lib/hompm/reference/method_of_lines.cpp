#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

#include <hompm/materials/material.hpp>
#include <hompm/number.hpp>
#include <hompm/numerics/band_ldlt.hpp>
#include <hompm/numerics/elementary.hpp>
#include <hompm/reference/lobatto.hpp>
#include <hompm/reference/method_of_lines.hpp>

namespace hompm {
namespace {

template <class Law>
class Lines {
 public:
  using State = std::vector<double>;  // displacements of all nodes, then velocities

  Lines(const Law& law, const Scene& scene, const Loads& loads, const Resolution& resolution,
        ReferenceWatch watch)
      : law_(law),
        watch_(std::move(watch)),
        density_(scene.material.density),
        loads_(loads),
        ends_(scene.ends),
        moves_(scene.kinematics == Kinematics::finite),
        rule_(lobatto_rule(resolution.degree)),
        degree_(static_cast<std::size_t>(resolution.degree)),
        elements_(static_cast<std::size_t>(resolution.elements)),
        nodes_(elements_ * degree_ + 1),
        width_(scene.body.length / static_cast<double>(elements_)),
        step_factor_(resolution.step_factor),
        gradient_(rule_.derivative),
        inverse_mass_(nodes_),
        state_(2 * nodes_),
        stress_(degree_ + 1),
        stiff_(stable_step() < worth_an_implicit_one * implicit_step()),
        matrix_(stiff_ ? nodes_ : 0) {
    for (double& entry : gradient_) entry *= 2.0 / width_;
    for (std::size_t e = 0; e < elements_; ++e) {
      for (std::size_t i = 0; i <= degree_; ++i) {
        const std::size_t node = e * degree_ + i;
        const double place =
            (static_cast<double>(e) + 0.5 * (1.0 + rule_.nodes[i])) / static_cast<double>(elements_);
        if (scene.initial_velocity)
          state_[nodes_ + node] = scene.initial_velocity->at(place, scene.body.length);
        if (scene.initial_displacement) {
          state_[node] = scene.initial_displacement->at(place, scene.body.length);
          smallest_stretch_ = std::min(smallest_stretch_,
                                       1.0 + scene.initial_displacement->slope_at(place, scene.body.length));
        }
        inverse_mass_[node] += 0.5 * width_ * density_ * rule_.weights[i];
      }
    }
    for (double& entry : inverse_mass_) entry = 1.0 / entry;
    if (ends_.left == End::fixed) state_[nodes_] = 0.0;  // whatever the field at the start says
    if (ends_.right == End::fixed) state_[2 * nodes_ - 1] = 0.0;
  }

  /// The right-hand side, as odeint calls it.
  void operator()(const State& state, State& rate, double time) {
    const std::size_t n = degree_ + 1;
    const double* u = state.data();
    const double* v = u + nodes_;
    double* force = rate.data() + nodes_;
    std::copy(v, v + nodes_, rate.data());
    std::fill(force, force + nodes_, 0.0);
    double smallest = std::numeric_limits<double>::infinity();
    bool valid = true;
    for (std::size_t e = 0; e < elements_; ++e) {
      const double* at = u + e * degree_;
      for (std::size_t i = 0; i < n; ++i) {
        double stretch = 1.0;
        for (std::size_t j = 0; j < n; ++j) stretch += gradient_[i * n + j] * at[j];
        smallest = std::min(smallest, stretch);
        valid = valid && stretch > collapsed;  // and so a number
        stress_[i] = 0.5 * width_ * rule_.weights[i] *
                     (law_.stress(stretch) + viscous_stress(v + e * degree_, i, stretch));
      }
      double* f = force + e * degree_;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) f[j] -= gradient_[i * n + j] * stress_[i];
      }
    }
    smallest_stretch_ = smallest;
    valid_ = valid_ && valid;
    force[0] -= total(loads_.left, time);
    force[nodes_ - 1] += total(loads_.right, time);
    const double acceleration = total(loads_.gravity, time);
    for (std::size_t i = 0; i < nodes_; ++i)
      force[i] = force[i] * inverse_mass_[i] + acceleration - loads_.damping_rate * v[i];
    if (ends_.left == End::fixed) force[0] = rate[0] = 0.0;
    if (ends_.right == End::fixed) force[nodes_ - 1] = rate[nodes_ - 1] = 0.0;
  }

  /// At a node of the element whose velocities begin at `v`.
  [[nodiscard]] double viscous_stress(const double* v, std::size_t node, double stretch) const {
    if (loads_.viscosity == 0.0) return 0.0;
    double rate = 0.0;
    for (std::size_t j = 0; j <= degree_; ++j) rate += gradient_[node * (degree_ + 1) + j] * v[j];
    return loads_.viscosity * (moves_ ? rate / stretch : rate);
  }

  void advance(double time) {
    if (time < time_) throw Error("the reference solution cannot go back in time");
    const double from = time_;
    while (time_ < time) {
      if (watch_) watch_((time_ - from) / (time - from));
      const double steps = std::ceil((time - time_) / (stiff_ ? implicit_step() : stable_step()));
      const double step = (time - time_) / steps;
      if (stiff_)
        do_implicit_step(step);
      else
        stepper_.do_step(std::ref(*this), state_, time_, step);
      time_ = steps > 1.0 ? time_ + step : time;
      if (!valid_) {
        throw Error("no smooth reference solution exists beyond t = " + to_text(time_) +
                    " s: the material turns inside out or gives way");
      }
    }
  }

  ReferenceFields at(double time, std::span<const double> X) {
    advance(time);
    ReferenceFields fields;
    std::vector<double> stretch(degree_ + 1);
    std::vector<double> viscous(degree_ + 1);
    for (const double x : X) {
      const double place = std::clamp(x / width_, 0.0, static_cast<double>(elements_));
      const std::size_t e = std::min(static_cast<std::size_t>(place), elements_ - 1);
      const double xi = 2.0 * (place - static_cast<double>(e)) - 1.0;
      const std::span<const double> u(state_.data() + e * degree_, degree_ + 1);
      const std::span<const double> v(state_.data() + nodes_ + e * degree_, degree_ + 1);
      for (std::size_t i = 0; i <= degree_; ++i) {
        stretch[i] = 1.0;
        for (std::size_t j = 0; j <= degree_; ++j) stretch[i] += gradient_[i * (degree_ + 1) + j] * u[j];
        viscous[i] = viscous_stress(v.data(), i, stretch[i]);
      }
      fields.displacement.push_back(rule_.interpolate(u, xi));
      fields.velocity.push_back(rule_.interpolate(v, xi));
      fields.stretch.push_back(rule_.interpolate(stretch, xi));
      fields.stress.push_back(law_.stress(fields.stretch.back()) + rule_.interpolate(viscous, xi));
    }
    return fields;
  }

 private:
  // Below this stretch the material counts as inside out, lest the stable step shrink to nothing.
  static constexpr double collapsed = 1e-4;

  // Of the costs of two steps.
  static constexpr double worth_an_implicit_one = 0.1;

  // Every law is stiffest where it is most compressed.
  [[nodiscard]] double fastest() const { return std::sqrt(law_.tangent(smallest_stretch_) / density_); }

  [[nodiscard]] double implicit_step() const {
    return step_factor_ * width_ / static_cast<double>(degree_) / fastest();
  }

  [[nodiscard]] double stable_step() const {
    const double speed = fastest();
    const double spacing = 0.5 * width_ * (rule_.nodes[1] - rule_.nodes[0]);
    const double step = step_factor_ * spacing / speed;
    if (loads_.viscosity == 0.0) return step;
    // The largest rate of decay is some 10 η/(ρ spacing²); the method is stable up to 2.78 over it.
    return std::min(step, 0.2 * spacing * spacing * density_ / loads_.viscosity);
  }

  /// By the L-stable method of order 4 with five stages, each implicit in itself alone, of E. Hairer, G.
  /// Wanner, Solving Ordinary Differential Equations II, table IV.6.5. What is unknown in a stage is its
  /// velocity V, with u* + γh V the displacement: (M + γh C + γ²h² K) δV = M (v* + γh a(V) − V), with K and C
  /// those of the start of the step.
  void do_implicit_step(double h) {
    constexpr std::size_t stages = 5;
    constexpr double gamma = 0.25;
    constexpr double a[stages][stages] = {{gamma},
                                          {1.0 / 2.0, gamma},
                                          {17.0 / 50.0, -1.0 / 25.0, gamma},
                                          {371.0 / 1360.0, -137.0 / 2720.0, 15.0 / 544.0, gamma},
                                          {25.0 / 24.0, -49.0 / 48.0, 125.0 / 16.0, -85.0 / 12.0, gamma}};
    constexpr double c[stages] = {1.0 / 4.0, 3.0 / 4.0, 11.0 / 20.0, 1.0 / 2.0, 1.0};
    const double part = gamma * h;
    factorise(part);
    const State start = state_;
    State known(2 * nodes_);
    State rate(2 * nodes_);
    std::vector<double> change(nodes_);
    std::array<State, stages> rates;
    for (std::size_t s = 0; s < stages; ++s) {
      known = start;
      for (std::size_t j = 0; j < s; ++j)
        for (std::size_t i = 0; i < known.size(); ++i) known[i] += h * a[s][j] * rates[j][i];
      // `state_` goes on from the stage before. Newton's method ends where rounding does.
      double before = std::numeric_limits<double>::infinity();
      for (;;) {
        for (std::size_t i = 0; i < nodes_; ++i) state_[i] = known[i] + part * state_[nodes_ + i];
        (*this)(state_, rate, time_ + c[s] * h);
        for (std::size_t i = 0; i < nodes_; ++i)
          change[i] = (known[nodes_ + i] + part * rate[nodes_ + i] - state_[nodes_ + i]) / inverse_mass_[i];
        matrix_.solve(first_free(), last_free(), change);
        double largest = 0.0;
        for (std::size_t i = first_free(); i < last_free(); ++i) {
          state_[nodes_ + i] += change[i];
          largest = std::max(largest, std::abs(change[i]));
        }
        if (!valid_ || !(largest < 0.5 * before)) break;
        before = largest;
      }
      for (std::size_t i = 0; i < nodes_; ++i) state_[i] = known[i] + part * state_[nodes_ + i];
      rates[s].resize(2 * nodes_);
      for (std::size_t i = 0; i < known.size(); ++i) rates[s][i] = (state_[i] - known[i]) / part;
    }
  }

  /// M + γh C + γ²h² K for the present state.
  void factorise(double part) {
    const std::size_t n = degree_ + 1;
    matrix_.clear();
    for (std::size_t i = 0; i < nodes_; ++i) matrix_.lower(i, 0) = 1.0 / inverse_mass_[i];
    for (std::size_t e = 0; e < elements_; ++e) {
      const std::size_t first = e * degree_;
      for (std::size_t q = 0; q < n; ++q) {
        const double* g = &gradient_[q * n];
        double stretch = 1.0;
        double rate = 0.0;
        for (std::size_t j = 0; j < n; ++j) {
          stretch += g[j] * state_[first + j];
          rate += g[j] * state_[nodes_ + first + j];
        }
        const double viscosity = loads_.viscosity / (moves_ ? stretch : 1.0);
        const double tangent = law_.tangent(stretch) - (moves_ ? viscosity * rate / stretch : 0.0);
        const double weight = 0.5 * width_ * rule_.weights[q] * part * (viscosity + part * tangent);
        for (std::size_t i = 0; i < n; ++i)
          for (std::size_t j = 0; j <= i; ++j) matrix_.lower(first + i, i - j) += weight * g[i] * g[j];
      }
    }
    for (std::size_t i = 0; i < nodes_; ++i)
      matrix_.lower(i, 0) += part * loads_.damping_rate / inverse_mass_[i];
    valid_ = valid_ && matrix_.factorise(first_free(), last_free()) == last_free();
  }

  [[nodiscard]] std::size_t first_free() const { return ends_.left == End::fixed ? 1 : 0; }
  [[nodiscard]] std::size_t last_free() const { return nodes_ - (ends_.right == End::fixed ? 1 : 0); }

  Law law_;
  ReferenceWatch watch_;
  double density_;
  Loads loads_;
  Ends ends_;
  bool moves_;
  LobattoRule rule_;
  std::size_t degree_;
  std::size_t elements_;
  std::size_t nodes_;
  double width_;
  double step_factor_;
  std::vector<double> gradient_;  // ∂/∂X within an element, row by row
  std::vector<double> inverse_mass_;
  State state_;
  std::vector<double> stress_;
  double time_ = 0.0;
  double smallest_stretch_ = 1.0;
  bool valid_ = true;
  bool stiff_;
  numerics::BandLdlt<12> matrix_;  // at most: the degree of `suitable_resolution`
  boost::numeric::odeint::runge_kutta4<State> stepper_;
};

}  // namespace

Resolution suitable_resolution(const Scene& scene, const Loads& loads) {
  const auto sudden = [](const std::vector<Load>& of) {
    return std::ranges::any_of(
        of, [](const Load& load) { return load.value != 0.0 && !load.amplitude.smooth(); });
  };
  const bool fixed = scene.ends.left == End::fixed && scene.ends.right == End::fixed;
  const bool kinks = sudden(loads.gravity) || sudden(loads.left) || sudden(loads.right);
  const bool smooth = !kinks && (fixed || (!scene.initial_velocity && !scene.initial_displacement));
  int mode = 1;
  for (const auto& field : {scene.initial_velocity, scene.initial_displacement})
    if (field) mode = std::max(mode, field->mode);
  return smooth ? Resolution{8 + 8 * mode, 12, 0.25} : Resolution{std::max(96, 8 * mode), 4, 1.0};
}

FieldsAt method_of_lines(const Scene& scene, const Loads& loads, const Resolution& resolution,
                         const ReferenceWatch& watch) {
  return std::visit(
      [&](const auto& law) -> FieldsAt {
        auto lines =
            std::make_shared<Lines<std::decay_t<decltype(law)>>>(law, scene, loads, resolution, watch);
        return [lines](double time, std::span<const double> X) { return lines->at(time, X); };
      },
      make_material(scene.material));
}

}  // namespace hompm

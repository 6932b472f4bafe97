// The yardstick of speed: a step of `bspline` with p = 2 written out as bare loops, beside the library's.
//
//   bare_bspline check CELLS STEPS         exit code 1 unless both give the same bits
//   bare_bspline bare|library CELLS STEPS  the steps of one alone, for counting instructions
//   bare_bspline time CELLS STEPS          ns per particle and step, least of 300 rounds by turns: the bare
//                                          loops', then those of the library's bspline, tielen2017,
//                                          high-order
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/simulation/simulation.hpp>

namespace {

constexpr double time_step = 1e-5;

hompm::Scene bar(const std::string& cells, const std::string& scheme = "bspline") {
  return hompm::load_builtin("bar", "small",
                             {{"scheme.name", scheme, "scheme"}, {"scheme.cells", cells, "cells"}});
}

struct Triple {
  double a, b, c;
};

/// c0 + c1 t + c2 t² of the three functions on a cell: [first, inner or last cell][about its lower or upper
/// end][power].
constexpr Triple pieces[3][2][3] = {
    {{{1.0, 0.0, 0.0}, {-2.0, 2.0, 0.0}, {1.0, -1.5, 0.5}},
     {{0.0, 0.5, 0.5}, {0.0, -1.0, 1.0}, {1.0, -1.5, 0.5}}},
    {{{0.5, 0.5, 0.0}, {-1.0, 1.0, 0.0}, {0.5, -1.0, 0.5}},
     {{0.0, 0.5, 0.5}, {0.0, -1.0, 1.0}, {0.5, -1.0, 0.5}}},
    {{{0.5, 0.5, 0.0}, {-1.0, 1.0, 0.0}, {0.5, -1.5, 1.0}},
     {{0.0, 0.0, 1.0}, {0.0, -2.0, 2.0}, {0.5, -1.5, 1.0}}},
};

/// A bar between fixed ends under no load, of the law `rate`, whose particles stay in the grid: what this
/// scene needs and no more. Three passes over the particles; sums of a cell are locals.
class BareBar {
 public:
  explicit BareBar(const hompm::Scene& scene, const hompm::State& start)
      : particles(start.particles),
        modulus_(scene.material.youngs_modulus),
        inverse_width_(1.0 / start.grid.cell_width()),
        last_cell_(start.grid.cells() - 1),
        first_(particles.size()),
        values_(particles.size()),
        gradients_(particles.size()),
        mass_(start.fields.mass.size()),
        force_(mass_.size()),
        momentum_(mass_.size()),
        field_(mass_.size()) {}

  void step() {
    forces();
    for (std::size_t i = 0; i < field_.size(); ++i) field_[i] = mass_[i] > 0.0 ? -force_[i] / mass_[i] : 0.0;
    field_.front() = field_.back() = 0.0;
    velocities();
    for (std::size_t i = 0; i < field_.size(); ++i)
      field_[i] = mass_[i] > 0.0 ? momentum_[i] / mass_[i] : 0.0;
    field_.front() = field_.back() = 0.0;
    motion();
  }

  hompm::Particles particles;

 private:
  /// Basis, mass and internal force.
  void forces() {
    std::fill(mass_.begin(), mass_.end(), 0.0);
    std::fill(force_.begin(), force_.end(), 0.0);
    const std::size_t count = particles.size();
    const double* x = particles.position.data();
    const double* m = particles.mass.data();
    const double* volume = particles.volume.data();
    const double* stress = particles.stress.data();
    std::int32_t* first = first_.data();
    Triple* values = values_.data();
    Triple* gradients = gradients_.data();
    double* mass = mass_.data();
    double* force = force_.data();
    const double inverse_width = inverse_width_;
    const std::int32_t last_cell = last_cell_;
    std::int32_t cell = 0;
    double m0 = 0.0, m1 = 0.0, m2 = 0.0, f0 = 0.0, f1 = 0.0, f2 = 0.0;
    for (std::size_t p = 0; p < count; ++p) {
      const double q = x[p] * inverse_width;
      const auto at = static_cast<std::int32_t>(q);
      const double s = q - static_cast<double>(at);
      const bool upper = s > 0.5;
      const double t = s - (upper ? 1.0 : 0.0);
      const Triple* c = pieces[(at > 0 ? 1 : 0) + (at == last_cell ? 1 : 0)][upper ? 1 : 0];
      const double ta = c[2].a * t, tb = c[2].b * t, tc = c[2].c * t;
      const double la = ta + c[1].a, lb = tb + c[1].b, lc = tc + c[1].c;
      const Triple n{la * t + c[0].a, lb * t + c[0].b, lc * t + c[0].c};
      const Triple g{(ta + la) * inverse_width, (tb + lb) * inverse_width, (tc + lc) * inverse_width};
      values[p] = n;
      gradients[p] = g;
      first[p] = at;
      if (at != cell) {
        mass[cell] = m0, mass[cell + 1] = m1, mass[cell + 2] = m2;
        force[cell] = f0, force[cell + 1] = f1, force[cell + 2] = f2;
        cell = at;
        m0 = mass[at], m1 = mass[at + 1], m2 = mass[at + 2];
        f0 = force[at], f1 = force[at + 1], f2 = force[at + 2];
      }
      const double f = volume[p] * stress[p];
      m0 += m[p] * n.a, m1 += m[p] * n.b, m2 += m[p] * n.c;
      f0 += f * g.a, f1 += f * g.b, f2 += f * g.c;
    }
    mass[cell] = m0, mass[cell + 1] = m1, mass[cell + 2] = m2;
    force[cell] = f0, force[cell + 1] = f1, force[cell + 2] = f2;
  }

  /// Particle velocity from the acceleration, and its momentum.
  void velocities() {
    std::fill(momentum_.begin(), momentum_.end(), 0.0);
    const std::size_t count = particles.size();
    const double* m = particles.mass.data();
    double* v = particles.velocity.data();
    const std::int32_t* first = first_.data();
    const Triple* values = values_.data();
    const double* acceleration = field_.data();
    double* momentum = momentum_.data();
    for (std::size_t p = 0; p < count;) {
      const std::int32_t cell = first[p];
      const double a0 = acceleration[cell], a1 = acceleration[cell + 1], a2 = acceleration[cell + 2];
      double p0 = momentum[cell], p1 = momentum[cell + 1], p2 = momentum[cell + 2];
      for (; p < count && first[p] == cell; ++p) {
        const Triple n = values[p];
        v[p] += time_step * (n.a * a0 + n.b * a1 + n.c * a2);
        const double mv = m[p] * v[p];
        p0 += mv * n.a, p1 += mv * n.b, p2 += mv * n.c;
      }
      momentum[cell] = p0, momentum[cell + 1] = p1, momentum[cell + 2] = p2;
    }
  }

  /// Displacement, stretch and stress.
  void motion() {
    const std::size_t count = particles.size();
    const double* velocity = field_.data();
    const double* reference = particles.reference_position.data();
    const double* reference_volume = particles.reference_volume.data();
    double* u = particles.displacement.data();
    double* x = particles.position.data();
    double* volume = particles.volume.data();
    double* stretch = particles.stretch.data();
    double* stress = particles.stress.data();
    const std::int32_t* first = first_.data();
    const Triple* values = values_.data();
    const Triple* gradients = gradients_.data();
    const double modulus = modulus_;
    for (std::size_t p = 0; p < count;) {
      const std::int32_t cell = first[p];
      const double v0 = velocity[cell], v1 = velocity[cell + 1], v2 = velocity[cell + 2];
      for (; p < count && first[p] == cell; ++p) {
        const Triple n = values[p];
        const Triple g = gradients[p];
        const double strain = time_step * (g.a * v0 + g.b * v1 + g.c * v2);
        const double moved = u[p] + time_step * (n.a * v0 + n.b * v1 + n.c * v2);
        const double after = stretch[p] * (1.0 + strain);
        u[p] = moved;
        x[p] = reference[p] + moved;
        stress[p] += (modulus - stress[p]) * strain;
        stretch[p] = after;
        volume[p] = reference_volume[p] * after;
      }
    }
  }

  double modulus_;
  double inverse_width_;
  std::int32_t last_cell_;
  std::vector<std::int32_t> first_;
  std::vector<Triple> values_, gradients_;
  std::vector<double> mass_, force_, momentum_, field_;
};

template <class Stepper>
double nanoseconds(Stepper& stepper, int steps) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < steps; ++i) stepper.step();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() / steps;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const std::string mode = argv[1];
  const hompm::Scene scene = bar(argv[2]);
  const int steps = std::stoi(argv[3]);
  hompm::Simulation library(scene, time_step);
  BareBar bare(scene, library.state());
  if (mode == "bare") {
    nanoseconds(bare, steps);
  } else if (mode == "library") {
    nanoseconds(library, steps);
  } else if (mode == "check") {
    nanoseconds(bare, steps);
    nanoseconds(library, steps);
    const hompm::Particles& a = bare.particles;
    const hompm::Particles& b = library.state().particles;
    const bool same = a.displacement == b.displacement && a.velocity == b.velocity && a.stress == b.stress &&
                      a.stretch == b.stretch && a.volume == b.volume && a.position == b.position;
    if (!same) std::cerr << "the bare loop and the library differ\n";
    return same ? 0 : 1;
  } else {
    std::vector<hompm::Simulation> schemes;
    for (const char* name : {"bspline", "tielen2017", "high-order"})
      schemes.emplace_back(bar(argv[2], name), time_step);
    std::vector<double> least(1 + schemes.size(), std::numeric_limits<double>::infinity());
    for (int round = 0; round < 300; ++round) {
      least[0] = std::min(least[0], nanoseconds(bare, steps));
      for (std::size_t i = 0; i < schemes.size(); ++i)
        least[i + 1] = std::min(least[i + 1], nanoseconds(schemes[i], steps));
    }
    for (const double time : least) std::cout << time / static_cast<double>(bare.particles.size()) << ' ';
    std::cout << '\n';
  }
  return 0;
}

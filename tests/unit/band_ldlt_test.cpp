// The band solver against Eigen, and the Richardson iteration of Tielen et al. (2017) against the band
// solver.
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include <hompm/numerics/band_ldlt.hpp>
#include <hompm/numerics/gauss_legendre.hpp>
#include <hompm/numerics/spline_space.hpp>

#include "support/catch.hpp"

using hompm::numerics::BandLdlt;

namespace {

/// ∫ N_i N_j over `cells` spans of width 1, the last one filled up to `cut`.
template <int P>
Eigen::MatrixXd mass_matrix(int cells, double cut, BandLdlt<P>& band) {
  const hompm::numerics::SplineSpace space(P, cells + P, 0.0,
                                           1.0);  // margin, so that the cut span is an inner one
  const auto rule = hompm::numerics::gauss_legendre(P + 1);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(cells + P, cells + P);
  band.clear();
  for (int cell = 0; cell < cells; ++cell) {
    const double width = cell + 1 == cells ? cut : 1.0;
    for (std::size_t g = 0; g < rule.points.size(); ++g) {
      double values[P + 1];
      double gradients[P + 1];
      space.evaluate<P>({cell, width * rule.points[g]}, values, gradients);
      for (int i = 0; i <= P; ++i)
        for (int j = 0; j <= P; ++j) {
          const double entry = width * rule.weights[g] * values[i] * values[j];
          dense(cell + i, cell + j) += entry;
          if (j <= i)
            band.lower(static_cast<std::size_t>(cell + i), static_cast<std::size_t>(i - j)) += entry;
        }
    }
  }
  return dense;
}

template <int P>
void compare_with_eigen(double cut) {
  const int cells = 20;
  const auto rows = static_cast<std::size_t>(cells + P);
  BandLdlt<P> band(rows);
  const Eigen::MatrixXd dense = mass_matrix<P>(cells, cut, band);
  Eigen::VectorXd exact(cells + P);
  for (int i = 0; i < cells + P; ++i) exact(i) = 1.0 + 0.1 * i;
  const Eigen::VectorXd b = dense * exact;
  std::vector<double> x(b.data(), b.data() + b.size());
  REQUIRE(band.factorise(0, rows) == rows);
  band.solve(0, rows, x);
  const Eigen::VectorXd eigen = dense.ldlt().solve(b);
  // Both are backward stable: they may differ by eps times the condition number, which is below 1e6 for cut =
  // 0.5, p = 5.
  for (int i = 0; i < cells + P; ++i) CHECK(std::abs(x[static_cast<std::size_t>(i)] - eigen(i)) < 1e-9);
}

}  // namespace

TEST_CASE("the band solver agrees with Eigen") {
  const double cut = GENERATE(1.0, 0.5);
  compare_with_eigen<1>(cut);
  compare_with_eigen<2>(cut);
  compare_with_eigen<3>(cut);
  compare_with_eigen<4>(cut);
  compare_with_eigen<5>(cut);
}

TEST_CASE("a range of rows is solved as if the others were fixed at zero") {
  BandLdlt<2> band(12);
  const Eigen::MatrixXd dense = mass_matrix<2>(10, 1.0, band);
  std::vector<double> x(12, 1.0);
  REQUIRE(band.factorise(1, 11) == 11);
  band.solve(1, 11, x);
  const Eigen::VectorXd eigen = dense.block(1, 1, 10, 10).ldlt().solve(Eigen::VectorXd::Ones(10));
  for (int i = 0; i < 10; ++i) CHECK(std::abs(x[static_cast<std::size_t>(i + 1)] - eigen(i)) < 1e-12);
  CHECK(x[0] == 1.0);
  CHECK(x[11] == 1.0);
}

TEST_CASE("a matrix that is not positive definite is found, with its row") {
  BandLdlt<1> band(3);
  band.clear();
  band.lower(0, 0) = 1.0, band.lower(1, 0) = 1.0, band.lower(2, 0) = 1.0;
  band.lower(1, 1) = 1.0;
  CHECK(band.factorise(0, 3) == 1);
}

TEST_CASE("Richardson iteration with the row sums as preconditioner ends where the direct solve is") {
  const int cells = 20;
  BandLdlt<2> band(22);
  const Eigen::MatrixXd mass = mass_matrix<2>(cells, 1.0, band);
  Eigen::VectorXd b(22);
  for (int i = 0; i < 22; ++i) b(i) = 1.0 + 0.01 * i * i;
  std::vector<double> direct(b.data(), b.data() + 22);
  REQUIRE(band.factorise(0, 22) == 22);
  band.solve(0, 22, direct);

  const Eigen::VectorXd lumped = mass.rowwise().sum();
  Eigen::VectorXd v = b.cwiseQuotient(lumped);
  int rounds = 0;
  for (Eigen::VectorXd residual = b - mass * v; residual.norm() > 1e-9 * b.norm() && rounds < 10000;
       ++rounds) {
    v += residual.cwiseQuotient(lumped);
    residual = b - mass * v;
  }
  INFO(rounds << " rounds");
  CHECK(rounds < 10000);
  for (int i = 0; i < 22;
       ++i)  // residual 1e-9 |b|, smallest eigenvalue of the mass matrix about 0.01, |b| about 10
    CHECK(std::abs(v(i) - direct[static_cast<std::size_t>(i)]) < 1e-6);
}

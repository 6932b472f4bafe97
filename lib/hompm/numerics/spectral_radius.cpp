#include <algorithm>
#include <cmath>
#include <cstdint>

#include <hompm/numerics/spectral_radius.hpp>

namespace hompm::numerics {
namespace {

using Vector = std::vector<double>;
using Rows = std::vector<Vector>;

double dot(const Vector& a, const Vector& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// A vector with a part along every mode (Numerical Recipes' linear congruential generator).
Vector scattered(std::size_t size) {
  Vector v(size);
  std::uint32_t seed = 1;
  for (double& x : v) {
    seed = 1664525u * seed + 1013904223u;
    x = static_cast<double>(seed >> 8) / 8388608.0 - 1.0;
  }
  return v;
}

/// |λ|max of a small matrix: lim ‖Aᵐ‖^(1/m), m = 2^squarings, of the Frobenius norm. Matrices are scaled to
/// norm 1 before each squaring; only square roots are taken.
double largest_modulus(Rows a) {
  constexpr int squarings = 12;  // the norm's constant enters by its 4096th root
  double radius = 1.0;           // ‖A^(2^k)‖^(1/2^k), k squarings so far
  Rows square(a.size(), Vector(a.size()));
  for (int k = 0; k <= squarings; ++k) {
    double norm = 0.0;
    for (const auto& row : a) norm += dot(row, row);
    norm = std::sqrt(norm);
    if (!(norm > 0.0)) return 0.0;
    double root = norm;
    for (int r = 0; r < k; ++r) root = std::sqrt(root);
    radius *= root;
    if (k == squarings) break;
    for (auto& row : a)
      for (double& x : row) x /= norm;
    for (std::size_t i = 0; i < a.size(); ++i) {
      std::fill(square[i].begin(), square[i].end(), 0.0);
      for (std::size_t j = 0; j < a.size(); ++j)
        for (std::size_t m = 0; m < a.size(); ++m) square[i][m] += a[i][j] * a[j][m];
    }
    a.swap(square);
  }
  return radius;
}

/// The largest real part of the eigenvalues of a small matrix of spectral radius `radius`: far enough to the
/// right it is the largest modulus.
double rightmost(Rows a, double radius) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i][i] += 4.0 * radius;
  return largest_modulus(a) - 4.0 * radius;
}

}  // namespace

SpectralRadius spectral_radius(std::size_t size, const std::function<void(const Vector& x, Vector& y)>& apply,
                               double tolerance, int most) {
  SpectralRadius result;
  std::vector<Vector> basis{scattered(size)};
  Vector next(size);
  apply(basis[0], next);  // into the range of the map
  basis[0] = next;
  Rows projected;  // H_ij = q_i · A q_j
  int settled = 0;
  for (std::size_t k = 0;; ++k) {
    Vector& q = basis[k];
    const double length = std::sqrt(dot(q, q));
    // What is left has no direction of its own: the space so far holds every mode that the start has.
    const double scale = k == 0 ? 0.0 : std::abs(projected[k - 1][k - 1]);
    if (!(length > 1e-12 * scale)) {
      result.value = largest_modulus(projected);
      result.rightmost = rightmost(projected, result.value);
      result.converged = true;
      return result;
    }
    for (double& x : q) x /= length;
    for (auto& row : projected) row.push_back(0.0);
    projected.emplace_back(k + 1);
    if (k > 0) projected[k][k - 1] = length;
    apply(q, next);
    ++result.rounds;
    for (std::size_t i = 0; i <= k; ++i) {
      const double part = dot(basis[i], next);
      projected[i][k] = part;
      for (std::size_t j = 0; j < size; ++j) next[j] -= part * basis[i][j];
    }
    if (result.rounds % 4 == 0) {
      const double before = result.value;
      result.value = largest_modulus(projected);
      settled = std::abs(result.value - before) <= tolerance / 3.0 * result.value ? settled + 1 : 0;
      result.converged = settled == 2;
      if (result.converged || result.rounds >= most) {
        result.rightmost = rightmost(projected, result.value);
        return result;
      }
    }
    basis.push_back(next);
  }
}

}  // namespace hompm::numerics

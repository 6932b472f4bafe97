// What effects, laws and schemes add to the state: fields, declared once, and workspaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hompm {

struct State;

/// What the entries of a field belong to.
enum class Site {
  body,               ///< one value for the body
  particle,           ///< one entry per particle, markers included
  particle_function,  ///< `BasisAtParticles::stencil` entries per particle
  function,           ///< one entry per grid function
  workspace,          ///< an object of a class of its own
};

/// All that is to be said of a field. Traces, checkpoints, `--explain` and the columns of result files go by
/// it.
struct FieldInfo {
  std::string_view name;     ///< a word: of a declared field it is the column of result files, too
  std::string_view unit;     ///< SI, "–" for none
  std::string_view meaning;  ///< for --explain
  Site site = Site::particle;
  /// Kept from step to step: it has a value before the first one, and is part of traces and checkpoints. Else
  /// it is scratch, of use within a step once a stage has written it.
  bool persists = false;
  bool reported = false;  ///< a column of particles.csv and point data of a .vtu; for fields of particles
};

/// A field of a plan and the states that go with it; as `"particles.velocity"_field`, or from
/// `StageBuilder::field`.
struct Field {
  std::size_t index = std::numeric_limits<std::size_t>::max();
  bool operator==(const Field&) const = default;
  explicit operator bool() const { return index != Field{}.index; }
};

/// What a scheme computes from the state in one stage for others of the same step, where arrays do not do. It
/// follows from the state, and is copied with it.
class Workspace {
 public:
  virtual ~Workspace() = default;
  [[nodiscard]] virtual std::unique_ptr<Workspace> clone() const = 0;

 protected:
  Workspace() = default;
  Workspace(const Workspace&) = default;
  Workspace& operator=(const Workspace&) = default;
};

/// Its `clone`, by the copy constructor: `class LeastSquares : public Cloned<Workspace, LeastSquares>`.
template <class Base, class Derived>
class Cloned : public Base {
 public:
  [[nodiscard]] std::unique_ptr<Workspace> clone() const override {
    return std::make_unique<Derived>(static_cast<const Derived&>(*this));
  }
};

/// A field that is no member of the state's own, with its values.
struct DeclaredField {
  std::string name;  ///< with the group that goes with its site: "particles.plastic_strain"
  std::string unit, meaning;
  Site site = Site::particle;
  bool persists = false, reported = false;
  std::vector<double> values = {};
  std::unique_ptr<Workspace> workspace = {};

  DeclaredField(std::string full_name, const FieldInfo& info)
      : name(std::move(full_name)),
        unit(info.unit),
        meaning(info.meaning),
        site(info.site),
        persists(info.persists),
        reported(info.reported) {}
  DeclaredField(const DeclaredField& other) : DeclaredField(other.name, other.info()) {
    values = other.values;
    if (other.workspace) workspace = other.workspace->clone();
  }
  DeclaredField(DeclaredField&&) = default;
  DeclaredField& operator=(DeclaredField other) {
    swap(other);
    return *this;
  }
  ~DeclaredField() = default;

  [[nodiscard]] FieldInfo info() const { return {name, unit, meaning, site, persists, reported}; }

 private:
  void swap(DeclaredField& other) noexcept {
    std::swap(name, other.name);
    std::swap(unit, other.unit);
    std::swap(meaning, other.meaning);
    std::swap(site, other.site);
    std::swap(persists, other.persists);
    std::swap(reported, other.reported);
    std::swap(values, other.values);
    std::swap(workspace, other.workspace);
  }
};

}  // namespace hompm

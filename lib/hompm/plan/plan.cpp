#include <algorithm>
#include <set>

#include <hompm/plan/plan.hpp>
#include <hompm/plan/taken.hpp>

namespace hompm {
namespace {

const std::string& group_of(Site site) {
  static const std::array<std::string, 5> groups{"body.", "particles.", "basis.", "grid.", "workspace."};
  return groups[static_cast<std::size_t>(site)];
}

std::size_t entries(const State& state, Site site) {
  switch (site) {
    case Site::body: return 1;
    case Site::particle: return state.particles.size();
    case Site::particle_function: return state.basis.values.size();
    case Site::function: return state.fields.mass.size();
    default: return 0;
  }
}

/// A stage or a coupling, as one body sees it.
struct Use {
  const std::string& name;
  const Fields& reads;
  const Fields& changes;
  const Fields& writes;
};

std::vector<Use> uses_of(const Plan& plan, std::span<const Coupling> couplings, std::size_t body) {
  std::vector<Use> uses;
  for (std::size_t phase = 0; phase < plan.phases.size(); ++phase) {
    for (const Stage& stage : plan.phases[phase])
      uses.push_back({stage.name, stage.reads, stage.changes, stage.writes});
    for (const Coupling& coupling : couplings) {
      const std::size_t side = body - coupling.left;  // 0 and 1 where it is one of the two
      if (coupling.phase == static_cast<Phase>(phase) && side < 2)
        uses.push_back({coupling.name, coupling.reads[side], coupling.changes[side], coupling.writes[side]});
    }
  }
  return uses;
}

bool is_in(Field field, const Fields& fields) { return std::ranges::find(fields, field) != fields.end(); }

/// A value before any stage has run.
bool is_given(const FieldInfo& info, bool declared) {
  return info.persists && (declared || info.site == Site::body || info.site == Site::particle);
}

/// What is known of one field where a step has come to.
struct Trail {
  const std::string* writer = nullptr;  ///< the last one in this step
  bool unread = false;
};

void check_field(const std::vector<Use>& uses, Field field, const FieldInfo& info) {
  const std::string name(info.name);
  const auto first = std::ranges::find_if(uses, [&](const Use& use) { return is_in(field, use.writes); });
  const bool given = is_given(info, field.index >= core_fields.size());
  const std::string* writer = nullptr;  // the last one in this step
  bool unread = false;
  for (const Use& use : uses) {
    const bool changes = is_in(field, use.changes);
    const bool writes = is_in(field, use.writes);
    const auto fail = [&](const std::string& how) { throw Error("the stage \"" + use.name + "\" " + how); };
    if (changes || is_in(field, use.reads)) {
      if (!given && first == uses.end()) fail("reads " + name + ", which no stage writes");
      if (!info.persists && writer == nullptr)
        fail("reads " + name + " before the stage \"" + first->name + "\" writes it");
      unread = false;
    }
    if (writes && unread)
      fail("overwrites " + name + ", which the stage \"" + *writer + "\" has written and no stage has read");
    if (!writes && !changes) continue;
    writer = &use.name;
    unread = true;
  }
}

/// What an effect alone has dissipated: it may not give what another takes.
Field field_of_taken(const StageBuilder& builder, const std::string& name) {
  return builder.field({detail::taken_by_effect, "J/m²", "by " + name, Site::body, true});
}

}  // namespace

Field StageBuilder::field(const FieldInfo& info, double initial) const {
  const std::string name = group_of(info.site) + std::string(info.name);
  std::string unique = name;
  for (int number = 2; state.find(unique) != nullptr; ++number) unique = name + "_" + std::to_string(number);
  state.declared.emplace_back(unique, info).values.assign(entries(state, info.site), initial);
  return {core_fields.size() + state.declared.size() - 1};
}

void StageBuilder::add(Stage stage) const {
  stage.called_by = called_by;
  if (called_by.starts_with("effect ") && is_in("balance.dissipated"_field, stage.changes)) {
    const Field taken = field_of_taken(*this, stage.name);
    stage.changes.push_back(taken);
    stage.run = [run = std::move(stage.run), taken](State& s) {
      const double before = s.balance.dissipated;
      run(s);
      s[taken].front() += s.balance.dissipated - before;
    };
  }
  const Phase phase = stage.phase;
  plan[phase].push_back(std::move(stage));
}

void StageBuilder::add_total_stress() const {
  if (plan.adds_stress()) return;
  const Field total = field({"total_stress", "Pa", "of the law, and what is added to it"});
  plan.total_stress = total;
  add({.name = "total stress: that of the law",
       .phase = Phase::total_stress,
       .reads = {"particles.stress"_field},
       .writes = {total},
       .run = [total](State& s) { s[total] = s.particles.stress; }});
}

void PairBuilder::add(Coupling coupling) const {
  if (is_in("balance.dissipated"_field, coupling.changes[0])) {
    const Field taken = field_of_taken(left, coupling.name);
    coupling.changes[0].push_back(taken);
    coupling.run = [run = std::move(coupling.run), taken](State& a, State& b) {
      const double before = a.balance.dissipated + b.balance.dissipated;
      run(a, b);
      a[taken].front() += a.balance.dissipated + b.balance.dissipated - before;
    };
  }
  coupling.left = index;
  coupling.called_by = left.called_by;
  couplings.push_back(std::move(coupling));
}

void check_plan(const Plan& plan, const State& state, std::span<const Coupling> couplings, std::size_t body) {
  const std::vector<Use> uses = uses_of(plan, couplings, body);
  std::set<std::size_t> seen;
  for (const Use& use : uses)
    for (const Fields* fields : {&use.reads, &use.changes, &use.writes})
      for (const Field field : *fields) seen.insert(field.index);
  for (const std::size_t index : seen) check_field(uses, {index}, info_of(state, {index}));
}

}  // namespace hompm

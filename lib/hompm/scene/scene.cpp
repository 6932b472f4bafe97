#include <cmath>

#include <hompm/numerics/elementary.hpp>
#include <hompm/scene/scene.hpp>

namespace hompm {

namespace {

template <class Value>
const Value& parameter(const EffectSpec& spec, const std::string& key, const char* kind) {
  const auto said = spec.parameters.find(key);
  const Value* value = said == spec.parameters.end() ? nullptr : std::get_if<Value>(&said->second);
  if (value != nullptr) return *value;
  throw SceneError(spec.origin, "the effect " + spec.type + " needs the " + kind + " `" + key + '`');
}

}  // namespace

double EffectSpec::number(const std::string& key) const { return parameter<double>(*this, key, "number"); }

const std::string& EffectSpec::text(const std::string& key) const {
  return parameter<std::string>(*this, key, "word");
}

double InitialField::at(double place, double length) const {
  if (shape == "uniform") return amplitude;
  if (shape == "linear") return amplitude + gradient.value_or(0.0) * (place * length);
  return amplitude * numerics::sin_pi(mode * place);
}

double InitialField::slope_at(double place, double length) const {
  if (shape == "uniform") return 0.0;
  if (shape == "linear") return gradient.value_or(0.0);
  return amplitude * (numerics::pi * mode / length) * numerics::cos_pi(mode * place);
}

double InitialField::integral_to(double place, double length) const {
  if (shape == "uniform") return amplitude * (place * length);
  if (shape == "linear")
    return (amplitude + 0.5 * gradient.value_or(0.0) * (place * length)) * (place * length);
  return amplitude * length * (1.0 - numerics::cos_pi(mode * place)) / (numerics::pi * mode);
}

double Scene::displaced(double X) const {
  if (!initial_displacement) return X;
  return X + initial_displacement->at((X - body.left()) / body.length, body.length);
}

double InitialField::steepest(double length) const { return std::abs(slope_at(0.0, length)); }

std::vector<const Scene*> bodies_of(const Scene& scene) {
  if (scene.bodies.empty()) return {&scene};
  std::vector<const Scene*> all;
  for (const Scene& body : scene.bodies) all.push_back(&body);
  return all;
}

}  // namespace hompm

// From the choices of a scheme to the stages of a step.
#pragma once

#include <memory>

#include <hompm/materials/material.hpp>
#include <hompm/plan/plan.hpp>

namespace hompm {

/// Adds the stages that the choices of the builder's scene call for, for its degree, kinematics and ends.
std::shared_ptr<const Discretisation> join_scheme(const Material& material, const StageBuilder& builder);

}  // namespace hompm

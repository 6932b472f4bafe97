// From a row of the table of schemes to the stages of a step.
#pragma once

#include <hompm/materials/material.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm {

/// Adds the stages that `scheme` calls for, for the degree, kinematics and ends of the builder's scene.
void join_scheme(const Scheme& scheme, const Material& material, PlanBuilder& builder);

}  // namespace hompm

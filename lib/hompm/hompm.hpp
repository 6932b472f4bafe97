// The core: scenes as plain data, simulations step by step, whole runs, and the exact solutions they are
// judged by.
#pragma once

#include <hompm/build_info.hpp>
#include <hompm/effects/registry.hpp>
#include <hompm/error.hpp>
#include <hompm/materials/material.hpp>
#include <hompm/plan/plan.hpp>
#include <hompm/reference/reference.hpp>
#include <hompm/scene/scene.hpp>
#include <hompm/scheme/scheme.hpp>
#include <hompm/simulation/critical_step.hpp>
#include <hompm/simulation/run.hpp>
#include <hompm/simulation/simulation.hpp>
#include <hompm/simulation/time_step.hpp>
#include <hompm/simulation/warnings.hpp>

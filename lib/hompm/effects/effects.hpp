// What the file of an effect NAME needs: it defines `EffectType NAME()` here, and catalogue.cmake names it.
#pragma once

#include <hompm/effects/registry.hpp>
#include <hompm/plan/plan.hpp>

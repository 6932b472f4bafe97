// One include for Catch2 2.13 and 3, and what the two name differently.
#pragma once

// No try around each assertion, which a third of the code of a test would be: what is thrown there fails the
// test by its name.
#define CATCH_CONFIG_FAST_COMPILE

#include <string>

#if __has_include(<catch2/catch_test_macros.hpp>)
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators_all.hpp>
#include <catch2/matchers/catch_matchers_all.hpp>

namespace hompm::test {
inline auto contains(const std::string& part) { return Catch::Matchers::ContainsSubstring(part); }
}  // namespace hompm::test
#else
#include <catch2/catch.hpp>

namespace hompm::test {
inline auto contains(const std::string& part) { return Catch::Matchers::Contains(part); }
}  // namespace hompm::test
#endif

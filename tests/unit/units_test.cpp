// Numbers with a unit are the numbers of the key, to the bit.
#include <string>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/units.hpp>

#include "support/catch.hpp"

using namespace hompm;
using detail::converted;

TEST_CASE("a unit moves the decimal point and changes no bit") {
  struct Row {
    const char *text, *wanted, *plain;
  };
  for (const Row& row : {Row{"25 kPa", "Pa", "25e3"},
                         {"0.1MPa", "Pa", "0.1e6"},
                         {"1.6 g/cm3", "kg/m³", "1.6e3"},
                         {"1.6 g/cm³", "kg/m³", "1.6e3"},
                         {"1.6 t/m^3", "kg/m³", "1.6e3"},
                         {"3.3e-1 km/s", "m/s", "3.3e2"},
                         {"981 cm/s2", "m/s^2", "981e-2"},
                         {"-981 cm s^-2", "m/s^2", "-981e-2"},
                         {"7 mm", "m", "7e-3"},
                         {"0.3 µs", "s", "0.3e-6"},
                         {"0.7 kHz", "1/s", "0.7e3"},
                         {"0.7 1/ms", "Hz", "0.7e3"},
                         {"1e+3 N/m2", "Pa", "1e3"},
                         {"3 Pa s", "Pa s", "3"},
                         {"3 kPa ms", "Pa s", "3"},
                         {"0 kPa", "Pa", "0"},
                         {"1e-310 GPa", "Pa", "1e-301"}}) {
    CAPTURE(row.text);
    const auto found = converted(row.text, row.wanted);
    REQUIRE(found.value.has_value());
    CHECK(*found.value == std::stod(row.plain));  // correctly rounded, both
  }
}

TEST_CASE("wrong units are refused with the reason") {
  CHECK(converted("25 kN", "Pa").reason == "\"kN\" is no unit of what is in Pa");
  CHECK(converted("25 kPa", "").reason == "\"kPa\" is no unit of a number without one");
  CHECK(converted("25 kNm3", "Pa").reason.starts_with("\"kNm3\" is no unit; there are kg, g, t"));
  CHECK(converted("1 m^99", "m").reason.starts_with("\"m^99\" is no unit"));
  CHECK(converted("1 m^x", "m").reason.starts_with("\"m^x\" is no unit"));
  for (const char* text : {"1e308 km", "1e-308 mm", "1e99999999999999999999 m", "1e-400 m"}) {
    CAPTURE(text);
    CHECK(converted(text, "m").reason == "it is too small or too large for a number");
  }
  for (const char* text : {"", "m", "25", "kPa 25", "1e5"}) {
    CAPTURE(text);
    CHECK_FALSE(converted(text, "m").value.has_value());
    CHECK(converted(text, "m").reason.empty());
  }
}

TEST_CASE("a scene takes values with units, and symbols of the field lead to their keys") {
  const std::string text = builtin_scenes().front().text;
  const auto with = [&](const std::string& key, const std::string& value) {
    return parse_scene(text, "file", {{key, value, "--set " + key + '=' + value}});
  };
  CHECK(with("material.youngs_modulus", "\"25 kPa\"").material.youngs_modulus == 25e3);
  CHECK(with("material.youngs_modulus", "25 kPa").material.youngs_modulus == 25e3);
  const auto complaint = [](const std::string& added) -> std::string {
    try {
      parse_scene(added, "file", {});
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(complaint("[material]\nE = 1e5\n")
            .find("file:2:1: unknown key `E` in [material]; did you mean `youngs_modulus`?") !=
        std::string::npos);
  CHECK(complaint("[material]\nrho = 1e5\n").find("did you mean `density`?") != std::string::npos);
  CHECK(complaint("dt = 1e-3\n")
            .find("file:1:1: unknown key `dt` outside any table; did you mean `time_step` in [scheme]?") !=
        std::string::npos);
  CHECK(complaint("T = 1\n").find("did you mean `end_time`?") != std::string::npos);
  CHECK(complaint("g = 9.81\n").find("gravity is written [[effect]] with type = \"gravity\"") !=
        std::string::npos);
  CHECK(complaint("end_time = \"5 m\"\n").find("not \"5 m\": \"m\" is no unit of what is in s") !=
        std::string::npos);
}

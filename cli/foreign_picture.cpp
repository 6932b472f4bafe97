#include "foreign_picture.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include <hompm/kit/output/staging.hpp>
#include <hompm/number.hpp>

#include "child.hpp"
#include "common.hpp"

namespace hompm::cli {
namespace {

namespace fs = std::filesystem;

/// Panels of one picture: a row for each time, a column for each field.
struct Panels {
  std::vector<std::string> fields;
  std::vector<double> times;
  std::map<std::pair<std::string, double>, const ForeignCurves*> curves;
  std::map<std::string, double> scale;
};

const std::map<std::string, std::string> units{{"displacement", "m"}, {"velocity", "m/s"}, {"stress", "Pa"}};

Panels panels_of(const ForeignComparison& comparison) {
  Panels panels;
  for (std::size_t i = 0; i < comparison.curves.size(); ++i) {
    const auto& curves = comparison.curves[i];
    if (units.count(curves.field) == 0) continue;
    if (panels.fields.empty() || panels.fields.back() != curves.field) panels.fields.push_back(curves.field);
    panels.times.push_back(curves.time);
    panels.curves[{curves.field, curves.time}] = &curves;
    panels.scale[curves.field] = comparison.fields[i].scale;
  }
  auto& times = panels.times;
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  // The start says little, and more than three rows are too small to see anything in.
  if (times.size() > 1 && times.front() == 0.0) times.erase(times.begin());
  if (times.size() > 3) times = {times.front(), times[times.size() / 2], times.back()};
  return panels;
}

/// A named block of data; points that are not finite are left out.
std::string data(const std::string& name, const std::vector<double>& X,
                 const std::function<double(std::size_t)>& value) {
  std::string text = "$" + name + " << EOD\n";
  for (std::size_t i = 0; i < X.size(); ++i) {
    if (std::isfinite(value(i))) text += to_text(X[i]) + " " + to_text(value(i)) + "\n";
  }
  return text + "EOD\n";
}

/// "plot …" of the blocks that hold something; an empty plot would end gnuplot.
class Plot {
 public:
  void add(const std::string& name, const std::vector<double>& X, const std::vector<double>& values,
           const std::string& style, const std::function<double(std::size_t)>& value) {
    const auto usable = [&](std::size_t i) { return std::isfinite(value(i)); };
    bool any = false;
    for (std::size_t i = 0; i < values.size(); ++i) any = any || usable(i);
    if (!any) return;
    data_ += data(name, X, value);
    curves_ += (curves_.empty() ? "plot " : ", ") + ("$" + name + " " + style);
  }
  void add(const std::string& name, const std::vector<double>& X, const std::vector<double>& values,
           const std::string& style) {
    add(name, X, values, style, [&](std::size_t i) { return values[i]; });
  }
  [[nodiscard]] std::string text() const {
    return data_ + (curves_.empty() ? "plot [0:1][0:1] NaN notitle" : curves_) + "\n";
  }

 private:
  std::string data_;
  std::string curves_;
};

// Okabe and Ito's colours, which everybody can tell apart.
const std::string style_a = "with points pointtype 7 pointsize 0.4 linecolor '#D55E00' title 'A'";
const std::string style_b = "with lines linewidth 2 linecolor '#0072B2' title 'B'";
const std::string style_exact = "with lines linewidth 1.5 dashtype 2 linecolor '#000000' title 'exact'";

std::string values_plot(const ForeignCurves& curves) {
  Plot plot;
  plot.add("b", curves.X_b, curves.b, style_b);
  plot.add("a", curves.X_a, curves.a, style_a);
  plot.add("exact", curves.X_b, curves.exact_b, style_exact);
  return plot.text();
}

std::string errors_plot(const ForeignCurves& curves, double scale) {
  // Zero has no logarithm.
  const auto part = [&](double error) { return error != 0.0 ? std::abs(error) / scale : std::nan(""); };
  Plot plot;
  const auto add = [&](const char* name, const std::vector<double>& X, const std::vector<double>& values,
                       const std::vector<double>& exact, const std::string& style) {
    if (exact.empty()) return;
    plot.add(name, X, values, style, [&](std::size_t i) { return part(values[i] - exact[i]); });
  };
  plot.add("ab", curves.X_matched, curves.difference,
           "with points pointtype 2 pointsize 0.4 linecolor '#009E73' title '|A-B|'",
           [&](std::size_t i) { return part(curves.difference[i]); });
  add("be", curves.X_b, curves.b, curves.exact_b,
      "with points pointtype 5 pointsize 0.3 linecolor '#0072B2' title '|B-exact|'");
  add("ae", curves.X_a, curves.a, curves.exact_a,
      "with points pointtype 7 pointsize 0.3 linecolor '#D55E00' title '|A-exact|'");
  return plot.text();
}

std::string script_of(const Panels& panels, bool svg) {
  const std::size_t rows = panels.times.size() + 1;
  const std::size_t columns = panels.fields.size();
  const std::string size = std::to_string(380 * columns) + "," + std::to_string(260 * rows);
  std::string script = "set encoding utf8\nset terminal " + std::string(svg ? "svg" : "pngcairo") + " size " +
                       size + " font 'Helvetica,12' background '#FFFFFF'\n" +
                       "set border 3 linecolor '#404040'\nset tics nomirror\nset grid linecolor "
                       "'#E0E0E0'\nset offsets 0,0,graph 0.3,0\n" +
                       "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) + "\n";
  const auto panel = [&](const std::string& field, const std::string& title, const std::string& key,
                         const std::string& plot) {
    const bool first = field == panels.fields.front();
    script += "set title '" + title + "'\n";
    script += (first ? "set key " + key + " right opaque samplen 1\n" : "unset key\n") + plot;
  };
  const auto at = [](double time) { return ", t = " + to_text(time) + " s"; };
  for (const double time : panels.times) {
    for (const auto& field : panels.fields) {
      const auto& curves = *panels.curves.at({field, time});
      panel(field, field + ", " + units.at(field) + at(time), "top", values_plot(curves));
    }
  }
  script += "set logscale y\nset format y '10^{%T}'\nset xlabel 'X, m'\n";
  for (const auto& field : panels.fields) {
    const double time = panels.times.back();
    const double scale = panels.scale.at(field);
    panel(field, "errors over " + rounded(scale) + " " + units.at(field) + at(time), "bottom",
          errors_plot(*panels.curves.at({field, time}), scale > 0.0 ? scale : 1.0));
  }
  return script + "unset multiplot\n";
}

}  // namespace

void require_picture_name(const std::string& file) {
  const auto ending = fs::path(file).extension();
  if (ending == ".svg" || ending == ".png") return;
  throw UsageError("--picture " + file + ": the name must end in .svg or .png");
}

std::string draw_picture(const ForeignComparison& comparison, const std::string& file) {
  const Panels panels = panels_of(comparison);
  if (panels.fields.empty()) return "there is no displacement, velocity or stress to draw";
  const auto picture = run_gnuplot(script_of(panels, fs::path(file).extension() == ".svg"));
  if (!picture) return "gnuplot is not installed (Debian package gnuplot-nox)";
  const auto folder = fs::absolute(file).parent_path();
  const std::string name = fs::path(file).filename();
  detail::StagingFolder staging(folder);
  auto out = staging.create(name);
  out << *picture;
  out.close();
  staging.move_into_place(name);
  return "";
}

}  // namespace hompm::cli

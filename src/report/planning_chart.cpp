// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>

#include <meshfarm/report/planning_report.hpp>

#include "report/lines.hpp"
#include "report/svg.hpp"

namespace meshfarm {
namespace {

constexpr double k_width = 760;
constexpr double k_height = 420;
constexpr double k_left = 60;
constexpr double k_right = 210;
constexpr double k_top = 40;
constexpr double k_bottom = 50;

using Value = std::function<double(const ScheduleLine&)>;

/// Vertical: time relative to ideal; horizontal: the number of jobs by powers of two.
class Chart {
 public:
  explicit Chart(const ScheduleComparison& comparison)
      : lines_(comparison.lines), svg_(k_width, k_height) {
    for (const ScheduleLine& each : lines_) {
      first_ = std::min(first_, std::log2(static_cast<double>(each.jobs)));
      last_ = std::max(last_, std::log2(static_cast<double>(each.jobs)));
      for (const double ratio :
           {each.dynamic_s / each.ideal_s, each.static_s / each.ideal_s,
            each.off_dynamic_s / each.off_ideal_s, each.off_static_s / each.off_ideal_s}) {
        highest_ = std::max(highest_, ratio);
      }
    }
    svg_.rect({0, 0}, k_width, k_height, "#fff");
    svg_.text({k_left, 20}, "Time over ideal, " + comparison.farm + " workers (Figure 4)");
    draw_grid();
  }

  void add(const std::string& name, const char* colour, const char* dash, const Value& value) {
    std::string path;
    for (const ScheduleLine& each : lines_) {
      const SvgPoint at = point(each, value(each));
      path += (path.empty() ? "M" : " L") + number(at.x, "%.1f") + " " + number(at.y, "%.1f");
      svg_.circle(
          at, 3, colour,
          name + ", " + std::to_string(each.jobs) + " jobs: " + number(value(each), "%.3f"));
    }
    svg_.path(path, colour, 2, dash);
    const double y = k_top + 12 + 20 * named_++;
    svg_.line({k_width - k_right + 16, y}, {k_width - k_right + 46, y}, colour, 2, dash);
    svg_.text({k_width - k_right + 52, y + 4}, name);
  }
  std::string str() const { return svg_.str(); }

 private:
  double x(double log2_jobs) const {
    const double range = std::max(1e-9, last_ - first_);
    return k_left + (log2_jobs - first_) / range * (k_width - k_left - k_right);
  }
  double y(double ratio) const {
    return k_height - k_bottom - (ratio - 1) / (highest_ - 1) * (k_height - k_top - k_bottom);
  }
  SvgPoint point(const ScheduleLine& line, double ratio) const {
    return {x(std::log2(static_cast<double>(line.jobs))), y(ratio)};
  }
  void draw_grid() {
    const double right = k_width - k_right;
    const double step = round_step(highest_ - 1, 8);
    for (double ratio = 1; ratio <= highest_; ratio += step) {
      svg_.line({k_left, y(ratio)}, {right, y(ratio)}, "#e4e4e4");
      svg_.text({k_left - 8, y(ratio) + 4}, number(ratio, "%.2f"), SvgAnchor::end);
    }
    for (const ScheduleLine& each : lines_) {
      const SvgPoint foot = point(each, 1);
      svg_.line({foot.x, k_top}, foot, "#e4e4e4");
      svg_.text({foot.x, foot.y + 18}, std::to_string(each.jobs), SvgAnchor::middle);
    }
    svg_.text({(k_left + right) / 2, k_height - 10}, "sub-meshes", SvgAnchor::middle);
  }

  const std::vector<ScheduleLine>& lines_;
  Svg svg_;
  double first_ = 64;
  double last_ = 0;
  double highest_ = 1.05;
  int named_ = 0;
};

}  // namespace

std::string draw(const ScheduleComparison& comparison) {
  Chart chart(comparison);
  const std::string off = ", speeds off";
  chart.add("dynamic", "#2060b0", "",
            [](const ScheduleLine& each) { return each.dynamic_s / each.ideal_s; });
  chart.add("static", "#d07020", "",
            [](const ScheduleLine& each) { return each.static_s / each.ideal_s; });
  chart.add("dynamic" + off, "#2060b0", "5 4",
            [](const ScheduleLine& each) { return each.off_dynamic_s / each.off_ideal_s; });
  chart.add("static" + off, "#d07020", "5 4",
            [](const ScheduleLine& each) { return each.off_static_s / each.off_ideal_s; });
  return chart.str();
}

}  // namespace meshfarm

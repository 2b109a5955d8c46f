#include "figure/ruler.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <string>
#include <tuple>

#include "core/text/number_text.h"
#include "figure/text.h"

namespace strata::figure {
namespace {

using Place = mesh::RolloutSheet::SurfacePlace;

constexpr double kTick = 1.2, kLabeledTick = 2, kGap = 0.7, kLetters = 2.2;
constexpr double kLine = 0.12, kOutline = 0.2;                                 // line widths
constexpr double kMinAngleLabels = 11, kMinLengthLabels = 8, kMinTicks = 1.4;  // distances
constexpr double kRounding = 1e-9;
// On paper. A fitted surface of 80 mm can be a little shorter, and still has a tick at 80 mm.
constexpr double kSlack = 0.02;
constexpr double kMmPerMetre = 1000;
// A longer edge is mostly outside of any paper.
constexpr double kLongestEdge = 20'000;
constexpr int kEdgePoints = 240;

// Returns the smallest of the steps with which labels are at least `labels` apart on paper, and the
// smallest step that divides it with which ticks are at least kMinTicks apart.
RulerSteps steps_of(const std::vector<double>& steps, double mm, double labels) {
  RulerSteps found{steps.back(), steps.back()};
  for (const double step : steps)
    if (step * mm >= labels) {
      found = {step, step};
      break;
    }
  for (const double step : steps) {
    const double count = found.label / step;
    if (std::abs(count - std::round(count)) < kRounding && step * mm >= kMinTicks) {
      found.tick = step;
      break;
    }
  }
  return found;
}

// Appends 1, 2 and 5 times each power of ten from 10^first to 10^last.
void add_decades(std::vector<double>& steps, int first, int last) {
  for (int power = first; power <= last; ++power)
    for (const double digit : {1, 2, 5}) steps.push_back(digit * std::pow(10, power));
}

// The part of the surface with rulers.
struct Part {
  double from = 0, to = 0, slant_from = 0, slant_to = 0;
};

Part part_of(const UnrolledDrawing& drawing) {
  const mesh::RolloutSheet& sheet = drawing.sheet;
  Part part{sheet.from, sheet.to, sheet.slant_from, sheet.slant_to};
  if (sheet.surface.is_cone()) return part;
  const glm::dvec2 half = drawing.area.size / 2.0 * drawing.units_per_mm;
  const glm::dvec2 low = glm::max(sheet.min, drawing.center - half),
                   high = glm::min(sheet.max, drawing.center + half);
  const auto angle_at = [&](double x) { return sheet.unbounded_place({x, 0}).angle; };
  std::tie(part.from, part.to) = std::minmax(angle_at(low.x), angle_at(high.x));
  part.slant_from = low.y;
  part.slant_to = high.y;
  return part;
}

class Ruler {
 public:
  explicit Ruler(const UnrolledDrawing& drawing) : drawing_(drawing), part_(part_of(drawing)) {}

  Group outline() const {
    Group group{"outline", {}};
    for (const double slant : {part_.slant_from, part_.slant_to})
      add_edge(group, {part_.from, slant}, {part_.to, slant});
    for (const double angle : {part_.from, part_.to})
      add_edge(group, {angle, part_.slant_from}, {angle, part_.slant_to});
    return group;
  }

  Group angles() const {
    Group group{"angle-ruler", {}};
    const bool is_upper_longer = mm_per_degree(part_.slant_to) > mm_per_degree(part_.slant_from);
    const double labeled = is_upper_longer ? part_.slant_to : part_.slant_from;
    const RulerSteps steps = angle_steps(mm_per_degree(labeled));
    for (const double slant : {part_.slant_from, part_.slant_to}) {
      const double mm = mm_per_degree(slant), side = slant == part_.slant_to ? 1 : -1;
      const double step = steps.tick * mm >= kMinTicks / 2 ? steps.tick : steps.label;
      if (glm::degrees(part_.to - part_.from) * mm > kLongestEdge || step * mm < kMinTicks / 2)
        continue;
      const double slack = kSlack / mm;
      for_each_tick(glm::degrees(part_.from) - slack, glm::degrees(part_.to) + slack, step,
                    [&](double degrees) {
                      const double angle = glm::radians(degrees);
                      add_tick(group, {angle, slant}, side * drawing_.sheet.up_at(angle),
                               is_multiple(degrees, steps.label),
                               slant == labeled ? angle_text(degrees) : std::string());
                    });
    }
    return group;
  }

  Group lengths() const {
    Group group{"length-ruler", {}};
    const double paper_mm = 1 / (drawing_.units_per_mm * drawing_.mm_per_unit);
    const auto length_at = [&](double slant) {
      return (slant - drawing_.zero_slant) * drawing_.mm_per_unit;
    };
    const double low = length_at(part_.slant_from) - kSlack / paper_mm,
                 high = length_at(part_.slant_to) + kSlack / paper_mm;
    if ((high - low) * paper_mm > kLongestEdge) return group;
    const RulerSteps steps = length_steps(paper_mm);
    const bool in_metres = steps.label >= kMmPerMetre;
    const double last = std::floor(high / steps.label) * steps.label;
    const auto text_of = [&](double mm) {
      std::string text = short_number(mm / (in_metres ? kMmPerMetre : 1));
      if (mm > last - steps.label / 2) text += in_metres ? " m" : " mm";
      return text;
    };
    const double left = drawing_.sheet.turn() > 0 ? part_.from : part_.to;
    for (const double angle : {part_.from, part_.to}) {
      const glm::dvec2 up = drawing_.sheet.up_at(angle), right(up.y, -up.x);
      for_each_tick(low, high, steps.tick, [&](double mm) {
        add_tick(group, {angle, drawing_.zero_slant + mm / drawing_.mm_per_unit},
                 angle == left ? -right : right, is_multiple(mm, steps.label),
                 angle == left ? text_of(mm) : std::string());
      });
    }
    return group;
  }

 private:
  double mm_per_degree(double slant) const {
    return glm::radians(drawing_.sheet.surface.min_stretch(slant)) / drawing_.units_per_mm;
  }

  static bool is_multiple(double value, double step) {
    return std::abs(value / step - std::round(value / step)) < kRounding * 1e3;
  }

  static std::string angle_text(double degrees) {
    double shown = std::fmod(degrees, 360);
    if (shown < -kRounding) shown += 360;
    return short_number(std::abs(shown)) + "°";
  }

  template <class See>
  static void for_each_tick(double from, double to, double step, See see) {
    const auto last = static_cast<long>(std::floor(to / step));
    for (auto i = static_cast<long>(std::ceil(from / step)); i <= last; ++i)
      see(static_cast<double>(i) * step);
  }

  bool is_in_area(const glm::dvec2& paper) const {
    constexpr double kBorder = 2 * kSlack;
    const glm::dvec2 from = paper - drawing_.area.corner, to = from - drawing_.area.size;
    return from.x >= -kBorder && from.y >= -kBorder && to.x <= kBorder && to.y <= kBorder;
  }

  // Adds the parts of an edge that are inside the area.
  void add_edge(Group& group, const Place& from, const Place& to) const {
    const int steps = drawing_.sheet.surface.is_cone() ? kEdgePoints : 1;
    Path line{{}, false, {}, kOutline};
    const auto end = [&] {
      if (line.points.size() > 1) group.items.push_back(line);
      line.points.clear();
    };
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const glm::dvec2 paper = drawing_.on_paper(
          {std::lerp(from.angle, to.angle, share), std::lerp(from.slant, to.slant, share)});
      if (is_in_area(paper))
        line.points.push_back(paper);
      else
        end();
    }
    end();
  }

  // `outward` is a direction on the sheet, from the surface. A tick without a text has no label.
  void add_tick(Group& group, const Place& place, const glm::dvec2& outward, bool is_long,
                const std::string& text) const {
    const glm::dvec2 from = drawing_.on_paper(place), out(outward.x, -outward.y);
    if (!is_in_area(from)) return;
    const double length = is_long ? kLabeledTick : kTick;
    group.items.push_back(Path{{from, from + length * out}, false, {}, kLine});
    if (!is_long || text.empty()) return;
    const glm::dvec2 half(width_mm(text, kLetters, false) / 2, kLetters / 2);
    const glm::dvec2 middle =
        from + (length + kGap + std::abs(out.x) * half.x + std::abs(out.y) * half.y) * out;
    constexpr double kBaseline = 0.36;  // below the middle of the letters, relative to their height
    group.items.push_back(
        Words{middle + glm::dvec2(0, kBaseline * kLetters), text, kLetters, false, Anchor::middle});
  }

  const UnrolledDrawing& drawing_;
  const Part part_;
};

}  // namespace

glm::dvec2 UnrolledDrawing::on_paper(const mesh::RolloutSheet::SurfacePlace& place) const {
  const glm::dvec2 from_center = (sheet.on_sheet(place) - center) / units_per_mm;
  return area.corner + area.size / 2.0 + glm::dvec2(from_center.x, -from_center.y);
}

RulerSteps angle_steps(double mm) {
  static const std::vector<double> kSteps = [] {
    std::vector<double> steps;
    add_decades(steps, -4, 0);
    for (const double step : {10, 15, 30, 45, 90, 180, 360}) steps.push_back(step);
    return steps;
  }();
  return steps_of(kSteps, mm, kMinAngleLabels);
}

RulerSteps length_steps(double mm) {
  static const std::vector<double> kSteps = [] {
    std::vector<double> steps;
    add_decades(steps, -4, 9);
    return steps;
  }();
  return steps_of(kSteps, mm, kMinLengthLabels);
}

std::vector<Group> ruler_groups(const UnrolledDrawing& drawing) {
  const Ruler ruler(drawing);
  return {ruler.outline(), ruler.angles(), ruler.lengths()};
}

}  // namespace strata::figure

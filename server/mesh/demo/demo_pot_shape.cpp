#include "mesh/demo/demo_pot_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "mesh/demo/demo_pot_noise.h"

namespace strata::mesh {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSplitHeight = 50;  // rings below are level, rings above follow the broken rim
constexpr double kHeight = 91;

// Profiles as (distance from the axis, height).
constexpr glm::dvec2 kOuterLower[] = {
    {0, 2.0},    {12, 1.9},  {22, 1.6},  {25.5, 0.4}, {28.5, 0.0}, {30.6, 1.6},         {30.2, 4.5},
    {33.0, 9.5}, {39.0, 18}, {44.6, 27}, {48.6, 36},  {50.4, 44},  {50.3, kSplitHeight}};
constexpr glm::dvec2 kOuterUpper[] = {{50.3, 50},   {48.6, 56}, {45.0, 62},
                                      {40.0, 67.5}, {35.6, 72}, {33.0, 76.5},
                                      {32.6, 81},   {34.6, 86}, {38.2, 91}};
constexpr glm::dvec2 kInnerLower[] = {{44.6, kSplitHeight}, {44.4, 42}, {42.2, 33},
                                      {38.0, 24},           {31.5, 16}, {23.0, 11.2},
                                      {12.0, 9.4},          {5.0, 9.1}, {0, 9.0}};

glm::dvec2 catmull_rom(std::span<const glm::dvec2> points, double u) {
  const auto last = static_cast<int>(points.size()) - 1;
  const int i = std::clamp(static_cast<int>(u), 0, last - 1);
  const double f = u - i;
  const glm::dvec2 p1 = points[i], p2 = points[i + 1];
  const glm::dvec2 p0 = i > 0 ? points[i - 1] : 2.0 * p1 - p2,
                   p3 = i + 2 <= last ? points[i + 2] : 2.0 * p2 - p1;
  return 0.5 * (2.0 * p1 + f * (p2 - p0) + f * f * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) +
                f * f * f * (3.0 * p1 - p0 - 3.0 * p2 + p3));
}

// A profile that is sampled by length, or by height if the height increases along it.
class Profile {
 public:
  explicit Profile(std::span<const glm::dvec2> points) {
    constexpr int kSamples = 800;
    double length = 0;
    for (int i = 0; i <= kSamples; ++i) {
      const glm::dvec2 p = catmull_rom(
          points, static_cast<double>(i) / kSamples * static_cast<double>(points.size() - 1));
      if (i > 0) length += glm::distance(p, samples_.back());
      samples_.push_back(p);
      lengths_.push_back(length);
    }
  }
  glm::dvec2 at(double t) const {
    const double length = std::clamp(t, 0.0, 1.0) * lengths_.back();
    return between(lengths_, length);
  }
  glm::dvec2 at_height(double z) const {
    const auto above =
        std::lower_bound(samples_.begin() + 1, samples_.end() - 1, z,
                         [](const glm::dvec2& p, double height) { return p.y < height; });
    const glm::dvec2 a = *(above - 1), b = *above;
    return glm::mix(a, b, (z - a.y) / (b.y - a.y));
  }
  // Returns a unit normal. For an upward outer profile it points away from the axis.
  glm::dvec2 normal(double t) const {
    return turned(at(std::min(1.0, t + 0.004)) - at(std::max(0.0, t - 0.004)));
  }
  glm::dvec2 normal_at_height(double z) const {
    return turned(at_height(z + 0.3) - at_height(z - 0.3));
  }

 private:
  static glm::dvec2 turned(const glm::dvec2& along) {
    return glm::normalize(glm::dvec2(along.y, -along.x));
  }
  glm::dvec2 between(const std::vector<double>& keys, double key) const {
    const auto above = std::lower_bound(keys.begin() + 1, keys.end() - 1, key);
    const auto i = static_cast<std::size_t>(above - keys.begin());
    return glm::mix(samples_[i - 1], samples_[i], (key - keys[i - 1]) / (keys[i] - keys[i - 1]));
  }
  std::vector<glm::dvec2> samples_;
  std::vector<double> lengths_;
};

const Profile& outer_lower() {
  static const Profile profile{kOuterLower};
  return profile;
}
const Profile& outer_upper() {
  static const Profile profile{kOuterUpper};
  return profile;
}
const Profile& inner_lower() {
  static const Profile profile{kInnerLower};
  return profile;
}

double bump(double distance, double width) {
  return std::exp(-distance * distance / (width * width));
}
double window(double z, double low, double high, double soft) {
  return glm::smoothstep(low - soft, low + soft, z) *
         (1 - glm::smoothstep(high - soft, high + soft, z));
}
// Returns the distance of `angle` from the nearest of `count` equal steps, as an arc length on a
// circle with the given radius.
double arc_in_cell(double angle, int count, double radius) {
  const double cells = angle / (2 * kPi) * count;
  return (cells - std::floor(cells) - 0.5) * 2 * kPi / count * radius;
}

struct Surface {
  double relief = 0;  // mm outward
  double paint = 0;   // 0…1, dark slip
  double ochre = 0;   // 0…1, red slip
  double cream = 0;   // 0…1, light ground
  double recess = 0;  // 0…1, amount of dirt
};

// Adds a rope around the pot: slanted strands on a round ridge.
void add_rope(Surface& s, double angle, double z, double center, double width, double height) {
  const double ridge = std::sqrt(std::max(0.0, 1 - (z - center) * (z - center) / (width * width)));
  const double strands = std::sin(52 * angle + (z - center) * 1.5);
  s.relief += ridge * height * (0.72 + 0.28 * strands);
  s.recess = std::max(s.recess, window(z, center - width - 0.7, center + width + 0.7, 0.3) *
                                    (1 - 0.8 * ridge) * 0.9);
  s.recess = std::max(s.recess, ridge * glm::smoothstep(0.3, 0.95, -strands) * 0.8);
}

// Adds tongues that rise from the foot like the petals of a bud.
void add_tongues(Surface& s, double angle, double z) {
  constexpr int kCount = 22;
  const double height = (z - 7.0) / 19.0;  // 0 at the foot, 1 at the tips
  if (height < -0.1 || height > 1.15) return;
  const double across = arc_in_cell(angle, kCount, 1.0) / (kPi / kCount);  // -1…1 in the cell
  const double half =
      0.9 *
      std::sqrt(std::clamp(1.0 - std::pow(std::max(0.0, height - 0.35) / 0.65, 2.0), 0.0, 1.0));
  const double inside = half > 0 ? 1 - std::pow(std::abs(across) / half, 2.0) : -1;
  const double foot = glm::smoothstep(0.0, 0.12, height);
  const double dome = inside > 0 ? std::sqrt(inside) : 0;
  s.relief += 1.7 * dome * foot;
  const double groove =
      foot * (1 - glm::smoothstep(0.0, 0.45, dome)) * (1 - glm::smoothstep(1.0, 1.12, height));
  s.recess = std::max(s.recess, groove);
  s.ochre = std::max(s.ochre, foot * glm::smoothstep(0.42, 0.55, dome) *
                                  (1 - glm::smoothstep(0.66, 0.78, dome)) * 0.8);
}

// Adds the frieze: a chain of connected spirals with bosses in the gaps.
void add_spirals(Surface& s, double angle, double z) {
  constexpr int kCount = 13;
  constexpr double kRadius = 50, kCenter = 40.6, kPitch = 4.3, kOuter = 7.4;
  const double field = window(z, 31.8, 49.4, 0.4);
  if (field <= 0) return;
  const double x = arc_in_cell(angle, kCount, kRadius), y = z - kCenter;
  const double r = std::hypot(x, y), turn = std::atan2(y, x) / (2 * kPi);
  const double coil = r / kPitch - turn;
  double distance = std::abs(coil - std::round(coil)) * kPitch;
  if (r > kOuter) distance = std::max(distance, (r - kOuter) + 0.4);
  // The bar runs from the foot of one spiral, across the edge of the cell, up to the crest above
  // the next spiral.
  const double cell = kPi / kCount * kRadius;
  const double wave =
      kOuter *
      std::cos(kPi / 2 * std::clamp((std::abs(x) - cell * 0.42) / (cell * 0.58), 0.0, 1.0));
  if (x > 0 || x < -0.3 * cell)
    distance = std::min(
        distance, std::abs(y - (x > 0 ? -wave : wave)) * (std::abs(x) > cell * 0.6 ? 0.72 : 0.9));
  if (r < 1.9) distance = std::min(distance, std::max(0.0, r - 0.9));
  const double raised = 1 - glm::smoothstep(0.75, 1.35, distance);
  double boss = 0;
  for (double side : {-1.0, 1.0}) {
    const double from = std::hypot(std::abs(x) - cell, y - side * 5.6) / 2.0;
    if (from < 1) boss = std::max(boss, std::sqrt(1 - from * from));
  }
  s.relief += field * std::max(1.15 * raised, 1.3 * boss);
  s.cream = field * (1 - raised) * (1 - glm::smoothstep(0.0, 0.3, boss));
  s.paint = std::max(s.paint, field * raised);
  s.ochre = std::max(s.ochre, field * glm::smoothstep(0.2, 0.5, boss));
  s.recess =
      std::max(s.recess, field * (1 - glm::smoothstep(0.0, 1.3, std::abs(distance - 1.5))) * 0.55);
}

// Adds incised zigzags on the shoulder. Every second triangle is filled with red.
void add_chevrons(Surface& s, double angle, double z) {
  const double field = window(z, 57.6, 68.2, 0.25);
  if (field <= 0) return;
  constexpr int kCount = 24;
  // 0 in the middle of a tooth, 1 at its side
  const double x = std::abs(arc_in_cell(angle, kCount, 1.0)) / (kPi / kCount);
  const double y = (z - 58.4) / 9.0;
  for (int line = 0; line < 3; ++line) {
    const double distance = std::abs(y - (1 - x) * 0.95 + 0.17 * line) * 5.2;
    const double cut = 1 - glm::smoothstep(0.28, 0.62, distance);
    s.relief -= field * 0.55 * cut;
    s.recess = std::max(s.recess, field * cut);
  }
  const double below = (1 - x) * 0.95 - 0.42 - y;
  s.ochre = std::max(s.ochre, field * glm::smoothstep(0.0, 0.05, below));
  s.cream = std::max(s.cream, field * 0.55 * glm::smoothstep(0.04, 0.08, y - (1 - x) * 0.95));
}

Surface outer_surface(double angle, double z) {
  Surface s;
  add_tongues(s, angle, z);
  add_rope(s, angle, z, 29.2, 1.7, 2.0);
  add_spirals(s, angle, z);
  add_rope(s, angle, z, 52.4, 1.7, 2.0);
  add_chevrons(s, angle, z);
  for (double center : {55.6, 70.3, 72.7, 75.1}) {
    s.relief += 1.25 * bump(z - center, 0.75);
    s.recess = std::max(
        s.recess, 0.8 * std::max(bump(z - center - 1.25, 0.45), bump(z - center + 1.25, 0.45)));
  }
  // The painted neck with unpainted leaves, and the bead of the lip.
  const double neck = window(z, 77.0, 86.4, 0.3);
  const double leaf_x = arc_in_cell(angle, 26, 33.0), leaf_y = (z - 81.6) / 4.0;
  const double leaf = glm::smoothstep(-0.15, 0.15, 1 - leaf_y * leaf_y - std::abs(leaf_x) / 1.6);
  s.paint = std::max(s.paint, neck * (1 - leaf));
  s.cream = std::max(s.cream, neck * leaf * 0.8);
  s.relief += neck * 0.45 * leaf;
  s.relief += 1.3 * bump(z - 89.6, 1.5);
  return s;
}

struct Break {
  double height;  // of the rim at this angle
  double broken;  // 0 intact lip … 1 fracture
};

// Returns the rim at an angle around the pot. The lip is intact at the back and broken in front,
// where one sherd is missing down to the shoulder.
Break rim_at(double angle) {
  struct Knot {
    double degrees, height;
  };
  static constexpr Knot kKnots[] = {
      {0, 91},     {58, 91},    {61, 89.2},  {66, 88.8},  {69, 91},    {196, 91},   {199, 88},
      {207, 89.2}, {213, 84.5}, {224, 86.5}, {229, 80.5}, {238, 82.2}, {243, 76.5}, {249, 74.8},
      {253, 66.0}, {258, 60.5}, {266, 58.2}, {272, 54.6}, {281, 55.8}, {288, 59.6}, {292, 67.5},
      {297, 69.8}, {301, 77.5}, {310, 79.4}, {314, 84.6}, {324, 82.6}, {330, 87.4}, {338, 86.2},
      {344, 89.6}, {348, 91},   {360, 91}};
  double degrees = angle * 180 / kPi;
  degrees -= 360 * std::floor(degrees / 360);
  std::size_t i = 1;
  while (i + 1 < std::size(kKnots) && kKnots[i].degrees < degrees) ++i;
  const Knot &a = kKnots[i - 1], &b = kKnots[i];
  const double height =
      glm::mix(a.height, b.height, (degrees - a.degrees) / (b.degrees - a.degrees));
  const double broken = glm::smoothstep(0.15, 1.3, kHeight - height);
  const glm::dvec3 place(std::cos(angle) * 40, std::sin(angle) * 40, 0);
  const double jag = 1.5 * fractal_noise(place * 0.33, 3) + 0.5 * noise(place * 1.3);
  return {std::min(kHeight, height + broken * jag), broken};
}

// Adds the irregularities of a hand-made shape. The pot is not quite round, leans slightly, and has
// finger marks.
glm::dvec3 wobbled(double radius, double z, double angle) {
  const double h = z / kHeight;
  const double round = 1 + 0.022 * std::cos(2 * (angle - 0.3)) +
                       h * (0.009 * std::cos(3 * angle + 1.1) + 0.004 * std::cos(5 * angle + 0.4));
  const glm::dvec3 on_circle(std::cos(angle), std::sin(angle), 0);
  glm::dvec3 p = on_circle * (radius * round);
  p.z = z * (1 + 0.007 * std::cos(angle - 2.1) * h);
  p.x += 1.3 * h * h;
  const glm::dvec3 q(on_circle.x * radius, on_circle.y * radius, z);
  const double clay = 0.35 * fractal_noise(q * 0.11, 2) + 0.16 * fractal_noise(q * 0.5 + 7.0, 3);
  const double off_axis = std::min(1.0, radius / 6.0);
  return p + on_circle * (clay * off_axis);
}

std::uint32_t pack(const glm::dvec3& color) {
  const glm::dvec3 c = glm::clamp(color, 0.0, 255.0);
  return static_cast<std::uint32_t>(std::lround(c.r)) |
         static_cast<std::uint32_t>(std::lround(c.g)) << 8 |
         static_cast<std::uint32_t>(std::lround(c.b)) << 16 | 0xff000000u;
}

const glm::dvec3 kClay(186, 118, 78), kPale(206, 146, 104), kPaint(66, 42, 36), kOchre(146, 58, 40),
    kCream(222, 188, 146), kDirt(84, 62, 48), kCore(122, 108, 98), kSoot(70, 58, 52);

glm::dvec3 clay_color(const glm::dvec3& p) {
  const double cloud = fractal_noise(p * 0.045 + 3.0, 3), grain = fractal_noise(p * 0.9, 2);
  return glm::mix(kClay, kPale, std::clamp(0.45 + 0.9 * cloud, 0.0, 1.0)) * (1 + 0.09 * grain);
}

std::uint32_t outer_color(const Surface& s, const glm::dvec3& p) {
  const double wear = fractal_noise(p * 0.22 + 11.0, 4);
  const double slip_share = glm::smoothstep(-0.34, -0.16, wear);  // slip has flaked off elsewhere
  const double chipped = glm::smoothstep(-0.25, 0.0, fractal_noise(p * 0.8 + 31.0, 2) + 0.22);
  glm::dvec3 color = clay_color(p);
  color = glm::mix(color, kCream * (1 + 0.06 * wear), s.cream * (0.55 + 0.45 * slip_share));
  color = glm::mix(color, kOchre * (1 + 0.2 * wear), s.ochre * slip_share * 0.92);
  color = glm::mix(color, kPaint * (1 + 0.3 * wear), s.paint * slip_share * (0.7 + 0.3 * chipped));
  const double dirt = s.recess * (0.62 + 0.35 * fractal_noise(p * 0.3 + 5.0, 2));
  color = glm::mix(color, kDirt, std::clamp(dirt, 0.0, 0.85));
  // A soot mark from the last fire, near the bottom on one side.
  const double soot = bump(glm::distance(p, glm::dvec3(-38, 30, 20)), 24) *
                      (0.75 + 0.8 * fractal_noise(p * 0.12, 3));
  return pack(glm::mix(color, kSoot, std::clamp(soot, 0.0, 0.75)));
}

std::uint32_t inner_color(const glm::dvec3& p) {
  const double lines = 0.06 * std::sin(p.z * 2.1 + 0.5 * fractal_noise(p * 0.1, 2));
  glm::dvec3 color = clay_color(p) * (0.86 + lines);
  const double deposit =
      (1 - glm::smoothstep(12.0, 30.0, p.z + 9 * fractal_noise(p * 0.15 + 2.0, 3)));
  return pack(glm::mix(color, glm::dvec3(150, 132, 112), 0.6 * deposit));
}

// The pot was fired briefly, so the core is gray between two red margins.
std::uint32_t fracture_color(double t, double broken, const glm::dvec3& p) {
  const double core = window(t, 0.28, 0.72, 0.12);
  glm::dvec3 color =
      glm::mix(clay_color(p) * 1.04, kCore * (1 + 0.2 * fractal_noise(p * 0.7, 2)), core);
  const double grit = glm::smoothstep(0.42, 0.55, noise(p * 1.7 + 41.0));
  color = glm::mix(color, glm::dvec3(226, 216, 200), 0.7 * grit);
  return pack(glm::mix(clay_color(p) * 0.93, color, broken));
}

double wall(double z) { return glm::mix(6.0, 4.6, glm::smoothstep(45.0, 85.0, z)); }

DemoPotShape::Point outside(const glm::dvec2& profile, const glm::dvec2& normal, double angle) {
  const Surface s = outer_surface(angle, profile.y);
  const glm::dvec2 moved = profile + normal * s.relief;
  const glm::dvec3 p = wobbled(moved.x, moved.y, angle);
  return {p, outer_color(s, p)};
}

DemoPotShape::Point inside(double radius, double z, double angle) {
  const double throwing = 0.22 * std::sin(z * 1.05 + angle) * std::min(1.0, radius / 10.0);
  const glm::dvec3 p = wobbled(radius + throwing, z, angle);
  return {p, inner_color(p)};
}

DemoPotShape::Point outside_at(double z, double angle) {
  return outside(outer_upper().at_height(z), outer_upper().normal_at_height(z), angle);
}
DemoPotShape::Point inside_at(double z, double angle) {
  return inside(outer_upper().at_height(z).x - wall(z), z, angle);
}

}  // namespace

DemoPotShape::Point DemoPotShape::at(Stretch stretch, double t, double angle) {
  switch (stretch) {
    case Stretch::underside_and_belly:
      return outside(outer_lower().at(t), outer_lower().normal(t), angle);
    case Stretch::shoulder_and_neck:
      return outside_at(glm::mix(kSplitHeight, rim_at(angle).height, t), angle);
    case Stretch::rim: {
      const Break rim = rim_at(angle);
      const glm::dvec3 outer = outside_at(rim.height, angle).position,
                       inner = inside_at(rim.height, angle).position;
      glm::dvec3 p = glm::mix(outer, inner, t);
      const double arch = std::sin(kPi * t);
      p.z += (1 - rim.broken) * 1.9 * arch;
      p.z += rim.broken * std::sqrt(arch) * (0.5 + 1.1 * fractal_noise(p * 0.55 + 23.0, 3));
      return {p, fracture_color(t, rim.broken, p)};
    }
    case Stretch::inside_upper:
      return inside_at(glm::mix(rim_at(angle).height, kSplitHeight, t), angle);
    case Stretch::inside_lower: {
      const glm::dvec2 p = inner_lower().at(t);
      return inside(p.x, p.y, angle);
    }
  }
  return {};
}

double DemoPotShape::radius(Stretch stretch, double t) {
  switch (stretch) {
    case Stretch::underside_and_belly: return outer_lower().at(t).x;
    case Stretch::inside_lower: return inner_lower().at(t).x;
    default: return 30;
  }
}

}  // namespace strata::mesh

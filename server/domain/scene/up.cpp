#include "domain/scene/up.h"

#include <algorithm>

namespace strata {

bool is_up(std::string_view name) {
  return std::ranges::find(kUpDirections, name) != kUpDirections.end();
}

UpFrame up_frame(std::string_view up) {
  UpFrame frame;
  const char axis = up.empty() ? 'z' : up.back();
  if (axis == 'x') frame = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  if (axis == 'y') frame = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  if (up.starts_with('-')) frame = {frame.right, -frame.into, -frame.up};
  return frame;
}

}  // namespace strata

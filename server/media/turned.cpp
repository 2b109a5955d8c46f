#include "media/turned.h"

#include <algorithm>

namespace strata {

Picture turned(Picture picture, int orientation) {
  if (orientation == 1) return picture;
  const bool swaps = orientation >= 5;
  Picture out{swaps ? picture.height : picture.width, swaps ? picture.width : picture.height, {}};
  out.rgba.resize(picture.rgba.size());
  const int right = picture.width - 1, bottom = picture.height - 1;
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      int from_x = swaps ? y : x, from_y = swaps ? x : y;
      if (orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8)
        from_x = right - from_x;
      if (orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7)
        from_y = bottom - from_y;
      const auto at = [](int column, int row, int width) {
        return 4 * (std::size_t(row) * std::size_t(width) + std::size_t(column));
      };
      std::copy_n(&picture.rgba[at(from_x, from_y, picture.width)], 4,
                  &out.rgba[at(x, y, out.width)]);
    }
  return out;
}

}  // namespace strata

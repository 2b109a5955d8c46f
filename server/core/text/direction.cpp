#include "core/text/direction.h"

#include <utf8proc.h>

namespace strata {

bool is_right_to_left(std::string_view text) {
  while (!text.empty()) {
    utf8proc_int32_t code = -1;
    const utf8proc_ssize_t bytes =
        utf8proc_iterate(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                         static_cast<utf8proc_ssize_t>(text.size()), &code);
    if (bytes < 1) return false;
    switch (utf8proc_get_property(code)->bidi_class) {
      case UTF8PROC_BIDI_CLASS_L: return false;
      case UTF8PROC_BIDI_CLASS_R:
      case UTF8PROC_BIDI_CLASS_AL: return true;
      default: text.remove_prefix(static_cast<std::size_t>(bytes));
    }
  }
  return false;
}

}  // namespace strata

#pragma once

#include <png.h>

#include <csetjmp>
#include <cstring>

namespace strata {

// libpng reports errors by longjmp, which only `guarded` catches. Code inside `guarded` must not
// hold objects with destructors. This header is for files that link libpng.

struct PngMessage {
  char text[200] = "damaged";
};

inline void keep_png_message(png_structp png, png_const_charp text) {
  auto* message = static_cast<PngMessage*>(png_get_error_ptr(png));
  std::strncpy(message->text, text, sizeof(message->text) - 1);
  png_longjmp(png, 1);
}

inline void ignore_png_warning(png_structp, png_const_charp) {}

// Returns false after an error, whose text is then in the PngMessage.
template <class Call>
bool guarded(png_structp png, const Call& call) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  call();
  return true;
}

// Owns the structs for writing. `info` is null if libpng cannot start.
struct PngWriter {
  PngMessage message;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, keep_png_message,
                                            ignore_png_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  PngWriter() = default;
  PngWriter(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

}  // namespace strata

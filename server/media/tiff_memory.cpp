#include "media/tiff_memory.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace strata {
namespace {

TiffMemory& memory(thandle_t handle) { return *static_cast<TiffMemory*>(handle); }

tmsize_t read_bytes(thandle_t handle, void* data, tmsize_t size) {
  TiffMemory& file = memory(handle);
  if (size <= 0 || file.at >= file.size()) return 0;
  const auto n = std::min<std::uint64_t>(static_cast<std::uint64_t>(size), file.size() - file.at);
  std::memcpy(data, (file.out ? file.out->data() : file.in.data()) + file.at, n);
  file.at += n;
  return static_cast<tmsize_t>(n);
}

tmsize_t write_bytes(thandle_t handle, void* data, tmsize_t size) {
  TiffMemory& file = memory(handle);
  if (!file.out || size < 0) return 0;
  if (file.at + size > file.out->size()) file.out->resize(file.at + size);
  std::memcpy(file.out->data() + file.at, data, size);
  file.at += size;
  return size;
}

toff_t seek_to(thandle_t handle, toff_t offset, int whence) {
  TiffMemory& file = memory(handle);
  if (whence == SEEK_SET) file.at = offset;
  if (whence == SEEK_CUR) file.at += offset;
  if (whence == SEEK_END) file.at = file.size() + offset;
  return file.at;
}

int close_nothing(thandle_t) { return 0; }
toff_t size_of(thandle_t handle) { return memory(handle).size(); }
int map_nothing(thandle_t, void**, toff_t*) { return 0; }
void unmap_nothing(thandle_t, void*, toff_t) {}

int keep_complaint(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  auto& complaint = static_cast<TiffMemory*>(user)->complaint;
  char text[300];
  std::vsnprintf(text, sizeof text, format, arguments);
  if (complaint.empty()) complaint = text;
  return 1;
}

int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

}  // namespace

Tiff open_tiff(TiffMemory& file, const char* mode) {
  std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                           TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_complaint, &file);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_warning, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), 2 * kMaxTiffTileBytes);
  return Tiff(TIFFClientOpenExt("file.tif", mode, &file, read_bytes, write_bytes, seek_to,
                                close_nothing, size_of, map_nothing, unmap_nothing, options.get()));
}

bool is_lossless(int compression) {
  switch (compression) {
    case COMPRESSION_NONE:
    case COMPRESSION_LZW:
    case COMPRESSION_DEFLATE:
    case COMPRESSION_ADOBE_DEFLATE:
    case COMPRESSION_PACKBITS:
    case COMPRESSION_LZMA:
    case COMPRESSION_ZSTD: return true;
    default: return false;
  }
}

}  // namespace strata

#include "query/maps/shapelib_memory.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace strata::query {
namespace {

// the object of this thread, because the hooks of shapelib have no user pointer
thread_local ShapelibMemory* current = nullptr;

ShapelibMemory::OpenFile& file_of(SAFile handle) {
  return *reinterpret_cast<ShapelibMemory::OpenFile*>(handle);
}

SAOffset read_bytes(void* to, SAOffset size, SAOffset count, SAFile handle) {
  auto& file = file_of(handle);
  if (size == 0 || file.at >= file.bytes.size()) return 0;
  const SAOffset whole = std::min<SAOffset>(count, (file.bytes.size() - file.at) / size);
  std::memcpy(to, file.bytes.data() + file.at, whole * size);
  file.at += whole * size;
  return whole;
}

SAOffset write_nothing(void*, SAOffset, SAOffset, SAFile) { return 0; }

SAOffset seek(SAFile handle, SAOffset offset, int whence) {
  auto& file = file_of(handle);
  if (whence == SEEK_SET) file.at = offset;
  if (whence == SEEK_CUR) file.at += offset;
  if (whence == SEEK_END) file.at = file.bytes.size() + offset;
  return 0;
}

SAOffset tell(SAFile handle) { return file_of(handle).at; }
int flush_nothing(SAFile) { return 0; }
int remove_nothing(const char*) { return -1; }
double number(const char* text) { return std::strtod(text, nullptr); }

int close(SAFile handle) {
  delete reinterpret_cast<ShapelibMemory::OpenFile*>(handle);
  return 0;
}

}  // namespace

ShapelibMemory::ShapelibMemory(Files files) : files_(std::move(files)), outer_(current) {
  current = this;
  hooks_.FOpen = open;
  hooks_.FRead = read_bytes;
  hooks_.FWrite = write_nothing;
  hooks_.FSeek = seek;
  hooks_.FTell = tell;
  hooks_.FFlush = flush_nothing;
  hooks_.FClose = close;
  hooks_.Remove = remove_nothing;
  hooks_.Error = complain;
  hooks_.Atof = number;
}

ShapelibMemory::~ShapelibMemory() { current = outer_; }

SAFile ShapelibMemory::open(const char* name, const char* access) {
  if (!current || std::strchr(access, 'w') || std::strchr(access, '+')) return nullptr;
  const auto found = current->files_.find(name);
  if (found == current->files_.end() || found->second.empty()) return nullptr;
  return reinterpret_cast<SAFile>(new OpenFile{found->second});  // close() deletes it
}

void ShapelibMemory::complain(const char* message) {
  if (current && current->complaint_.empty()) current->complaint_ = message;
}

std::string ShapelibMemory::complaint(const std::string& what) const {
  std::string words = complaint_.substr(0, 300);
  while (!words.empty() && (words.back() == '.' || words.back() == '\n')) words.pop_back();
  return what + (words.empty() ? "." : ": " + words + ".");
}

}  // namespace strata::query

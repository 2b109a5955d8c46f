#include "core/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace strata {
namespace {

tl::unexpected<Error> unreadable(std::string detail) {
  return fail(ErrorCode::invalid, "File not readable", std::move(detail), "file");
}

}  // namespace

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile::~MappedFile() {
  if (data_) ::munmap(data_, size_);
}

Result<MappedFile> MappedFile::open(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    return unreadable("The file cannot be opened: " + std::string(std::strerror(errno)) + ".");
  MappedFile mapped;
  struct stat status {};
  const bool regular = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  if (regular && status.st_size > 0) {
    void* data = ::mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ, MAP_PRIVATE,
                        descriptor, 0);
    if (data != MAP_FAILED) {
      mapped.data_ = data;
      mapped.size_ = static_cast<std::size_t>(status.st_size);
      ::madvise(data, mapped.size_, MADV_SEQUENTIAL);
    }
  }
  const int error = errno;
  ::close(descriptor);
  if (!regular) return unreadable("The path does not name a regular file.");
  if (status.st_size > 0 && !mapped.data_)
    return unreadable("The file cannot be read: " + std::string(std::strerror(error)) + ".");
  return mapped;
}

void MappedFile::release(std::string_view part) const {
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(part.data()) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(part.data() + part.size()) / page * page;
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
}

}  // namespace strata

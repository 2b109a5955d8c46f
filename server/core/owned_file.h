#pragma once

#include <cstdio>
#include <memory>

namespace strata {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
// A file that is closed at the end of its life. The error of `fclose` is then lost, so a writer
// must release the file and close it itself.
using OwnedFile = std::unique_ptr<std::FILE, CloseFile>;

}  // namespace strata

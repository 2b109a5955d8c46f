// This file is linked into every test that needs GL. It loads the driver libraries and never
// unloads them. LeakSanitizer checks at the end of the process, and reports leaks of an unloaded
// library without their function names.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace {

class KeepDriverLoaded : public testing::Environment {
 public:
  void SetUp() override {
    for (const char* name : {"libEGL_mesa.so.0", "libglapi.so.0", "libLLVM-15.so.1"})
      dlopen(name, RTLD_NOW | RTLD_NODELETE);
    for (const char* driver : {"/usr/lib/x86_64-linux-gnu/dri/swrast_dri.so",
                               "/usr/lib/aarch64-linux-gnu/dri/swrast_dri.so"}) {
      if (std::filesystem::exists(driver)) dlopen(driver, RTLD_NOW | RTLD_NODELETE);
    }
  }
};

[[maybe_unused]] const auto* const kEnvironment =
    testing::AddGlobalTestEnvironment(new KeepDriverLoaded);

}  // namespace

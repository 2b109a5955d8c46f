#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace strata::log {

enum class Level : std::uint8_t { debug, info, warning, error };
inline constexpr std::array<std::string_view, 4> kLevelNames{"debug", "info", "warning", "error"};

// The folders of server/, in the order of `kModuleNames`. `other` is all other code.
enum class Module : std::uint8_t {
  app,
  cli,
  core,
  domain,
  expression,
  figure,
  gl,
  jobs,
  media,
  mesh,
  net,
  query,
  render,
  report,
  room,
  store,
  stream,
  vocabulary,
  other
};
inline constexpr std::array<std::string_view, 19> kModuleNames{
    "app",  "cli",   "core",   "domain",     "expression", "figure", "gl",
    "jobs", "media", "mesh",   "net",        "query",      "render", "report",
    "room", "store", "stream", "vocabulary", "other"};
inline constexpr std::size_t kModules = kModuleNames.size();

constexpr std::string_view name(Level level) {
  return kLevelNames[static_cast<std::size_t>(level)];
}
constexpr std::string_view name(Module module) {
  return kModuleNames[static_cast<std::size_t>(module)];
}
std::optional<Level> level_named(std::string_view name);
constexpr std::optional<Module> module_named(std::string_view name) {
  const auto* const found = std::ranges::find(kModuleNames, name);
  if (found == kModuleNames.end()) return std::nullopt;
  return static_cast<Module>(found - kModuleNames.begin());
}

// Returns the module of a source file from its path, which may be relative. A header may have the
// path of the build folder, `modules/NAME/NAME/…`.
constexpr Module module_of_file(std::string_view path) {
  for (const std::string_view folder : {"server/", "modules/"}) {
    const auto at = path.rfind(folder);
    if (at == std::string_view::npos || (at > 0 && path[at - 1] != '/')) continue;
    const auto rest = path.substr(at + folder.size());
    if (const auto module = module_named(rest.substr(0, rest.find('/')))) return *module;
  }
  return Module::other;
}

// The lowest level of the lines that each module writes.
struct Levels {
  Level by_default = Level::info;
  std::array<std::optional<Level>, kModules> of_modules{};
  Level of(Module module) const {
    return of_modules[static_cast<std::size_t>(module)].value_or(by_default);
  }
  bool operator==(const Levels&) const = default;
};

// Reads a list such as `warning,store=debug,net=info`: at most one default level, and at most one
// level of each module. The error is `malformed`.
Result<Levels> parse_levels(std::string_view text);
std::string to_string(const Levels& levels);  // the default level first

}  // namespace strata::log

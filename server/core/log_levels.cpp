#include "core/log_levels.h"

namespace strata::log {
namespace {

template <class Names>
std::string joined(const Names& names) {
  std::string text;
  for (const auto& each : names) text.append(text.empty() ? "" : ", ").append(each);
  return text;
}

tl::unexpected<Error> wrong(const std::string& detail) {
  return fail(ErrorCode::malformed, "Invalid log level",
              detail + " Enter a level, or a list such as warning,store=debug.", "--log-level");
}

Result<Level> read_level(std::string_view text) {
  if (const auto level = level_named(text)) return *level;
  return wrong("`" + std::string(text) +
               "` is not a level. The levels are: " + joined(kLevelNames) + ".");
}

}  // namespace

std::optional<Level> level_named(std::string_view name) {
  const auto* const found = std::ranges::find(kLevelNames, name);
  if (found == kLevelNames.end()) return std::nullopt;
  return static_cast<Level>(found - kLevelNames.begin());
}

Result<Levels> parse_levels(std::string_view text) {
  Levels levels;
  bool has_default = false;
  for (bool is_last = false; !is_last;) {
    const auto comma = text.find(',');
    is_last = comma == std::string_view::npos;
    const std::string_view part = text.substr(0, comma);
    text.remove_prefix(is_last ? text.size() : comma + 1);
    const auto equals = part.find('=');
    if (equals == std::string_view::npos) {
      if (has_default) return wrong("The list contains two levels without a module.");
      levels.by_default = STRATA_TRY(read_level(part));
      has_default = true;
      continue;
    }
    const auto module = module_named(part.substr(0, equals));
    if (!module)
      return wrong("`" + std::string(part.substr(0, equals)) +
                   "` is not a module. The modules are: " + joined(kModuleNames) + ".");
    auto& level = levels.of_modules[static_cast<std::size_t>(*module)];
    if (level)
      return wrong("The list contains the module " + std::string(name(*module)) + " twice.");
    level = STRATA_TRY(read_level(part.substr(equals + 1)));
  }
  return levels;
}

std::string to_string(const Levels& levels) {
  std::string text(name(levels.by_default));
  for (std::size_t i = 0; i < kModules; ++i)
    if (levels.of_modules[i])
      text.append(",").append(kModuleNames[i]).append("=").append(name(*levels.of_modules[i]));
  return text;
}

}  // namespace strata::log

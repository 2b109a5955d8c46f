#include "core/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <array>
#include <atomic>
#include <chrono>
#include <ctime>
#include <mutex>
#include <nlohmann/json.hpp>

#include "core/overloaded.h"
#include "core/trace.h"

namespace strata::log {
namespace {

constexpr const char* kTextPattern = "%Y-%m-%dT%H:%M:%S.%e %L %v";
constexpr const char* kJsonPattern = "%v";

struct State {
  // Atomic, because each message reads them without a lock.
  std::array<std::atomic<Level>, kModules> least;
  std::atomic<bool> as_json{false};
  std::mutex mutex;
  Levels levels;  // the argument of the last set_levels
  State() { spread(); }
  void spread() {
    for (std::size_t i = 0; i < kModules; ++i) least[i] = levels.of(static_cast<Module>(i));
  }
};

State& state() {
  static State instance;
  return instance;
}

spdlog::logger& logger() {
  static auto instance = [] {
    auto made = spdlog::stderr_logger_mt("strata");
    made->set_pattern(kTextPattern);
    made->set_level(spdlog::level::debug);  // `is_enabled` decides
    made->flush_on(spdlog::level::warn);
    return made;
  }();
  return *instance;
}

// Returns the time in UTC with milliseconds (RFC 3339).
std::string time_now() {
  const auto now = std::chrono::system_clock::now();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(
                      now - std::chrono::system_clock::from_time_t(seconds))
                      .count();
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[40];
  const auto size = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  return std::string(text, size) + fmt::format(".{:03}Z", std::clamp<long long>(ms, 0, 999));
}

// Escapes control characters. Messages contain text of clients, such as paths, which must not be
// able to add lines to the log.
std::string on_one_line(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f)
      line += fmt::format("\\x{:02x}", code);
    else
      line += c;
  }
  return line;
}

std::string text_line(Module module, std::string_view message, std::span<const Field> fields) {
  std::string line = fmt::format("[{}] {}", name(module), message);
  for (const Field& field : fields)
    std::visit(
        Overloaded{[&](double value) { line += fmt::format(" {}={:.3f}", field.name, value); },
                   [&](const auto& value) { line += fmt::format(" {}={}", field.name, value); }},
        field.value);
  if (const TraceId& trace = current_trace()) line += " trace_id=" + to_string(trace);
  return on_one_line(line);
}

std::string json_line(Level level, Module module, std::string_view message,
                      std::span<const Field> fields) {
  nlohmann::ordered_json line{
      {"time", time_now()}, {"level", name(level)}, {"module", name(module)}, {"message", message}};
  if (const TraceId& trace = current_trace()) line["trace_id"] = to_string(trace);
  for (const Field& field : fields)
    std::visit([&](const auto& value) { line[std::string(field.name)] = value; }, field.value);
  // Messages may contain text from files and clients that is not valid UTF-8.
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

bool is_enabled(Level level, Where where) {
  return level >=
         state().least[static_cast<std::size_t>(where.module)].load(std::memory_order_relaxed);
}

void write(Level level, std::string_view message, std::span<const Field> fields, Where where) {
  if (!is_enabled(level, where)) return;
  constexpr spdlog::level::level_enum kLevels[] = {spdlog::level::debug, spdlog::level::info,
                                                   spdlog::level::warn, spdlog::level::err};
  const auto line = state().as_json ? json_line(level, where.module, message, fields)
                                    : text_line(where.module, message, fields);
  // The message may contain braces, so it is not used as a format string.
  logger().log(kLevels[static_cast<int>(level)], "{}", line);
}

void debug(std::string_view message, Where where) { write(Level::debug, message, {}, where); }
void info(std::string_view message, Where where) { write(Level::info, message, {}, where); }
void warning(std::string_view message, Where where) { write(Level::warning, message, {}, where); }
void error(std::string_view message, Where where) { write(Level::error, message, {}, where); }

void set_levels(const Levels& levels) {
  std::lock_guard lock(state().mutex);
  state().levels = levels;
  state().spread();
}

Levels levels() {
  std::lock_guard lock(state().mutex);
  return state().levels;
}

void set_format(Format format) {
  state().as_json = format == Format::json;
  logger().set_pattern(format == Format::json ? kJsonPattern : kTextPattern);
}

}  // namespace strata::log

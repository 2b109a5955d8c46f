#include "cli/support_machine.h"

#include <curl/curl.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <thread>

#include "cli/support_secrets.h"
#include "core/text/ascii.h"
#include "store/cluster/support_facts.h"

extern char** environ;

namespace strata::cli {
namespace {

constexpr std::size_t kMaxLog = 1 << 20;
constexpr int kMaxLines = 2000;
constexpr std::size_t kMaxReply = 4 << 20;
constexpr long kTimeout_s = 5;
constexpr const char* kServiceSettings = "/etc/default/strata";

std::string first_line(const std::filesystem::path& file) {
  std::string line;
  std::ifstream in(file);
  std::getline(in, line);
  return line;
}

nlohmann::json disk(const std::filesystem::path& folder) {
  std::error_code error;
  const auto space = std::filesystem::space(folder, error);
  if (error) return {{"problem", error.message()}};
  return {{"bytes", space.capacity}, {"free_bytes", space.available}};
}

// Returns the value of a variable for the bundle, without the secrets in the value.
std::string public_value(const std::string& name, const std::string& value) {
  if (value.empty()) return value;
  if (name == "STRATA_DATABASE") return store::without_passwords(value).text;
  for (const char* word : {"TOKEN", "PASSWORD", "SECRET", "ACCESS_KEY"})
    if (name.find(word) != std::string::npos) return "[set]";
  return redacted(value);
}

std::map<std::string, std::string> read_settings(const std::filesystem::path& file) {
  std::map<std::string, std::string> settings;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::string_view text = trimmed(line);
    const auto equals = text.find('=');
    if (text.empty() || text.front() == '#' || equals == std::string_view::npos) continue;
    const std::string name(trimmed(text.substr(0, equals)));
    settings[name] = public_value(name, std::string(trimmed(text.substr(equals + 1), " \t\"'")));
  }
  return settings;
}

std::size_t collect(char* data, std::size_t size, std::size_t count, void* body) {
  auto& text = *static_cast<std::string*>(body);
  if (text.size() + size * count > kMaxReply) return 0;  // ends the transfer
  text.append(data, size * count);
  return size * count;
}

std::optional<std::string> get(const std::string& url) {
  const std::unique_ptr<CURL, void (*)(CURL*)> curl(curl_easy_init(), &curl_easy_cleanup);
  if (!curl) return std::nullopt;
  std::string body;
  curl_easy_setopt(curl.get(), CURLOPT_URL, url.c_str());
  curl_easy_setopt(curl.get(), CURLOPT_TIMEOUT, kTimeout_s);
  curl_easy_setopt(curl.get(), CURLOPT_NOPROXY, "*");
  curl_easy_setopt(curl.get(), CURLOPT_NOSIGNAL, 1L);
  // The certificate names another host. No check is needed, because the server is on this machine.
  curl_easy_setopt(curl.get(), CURLOPT_SSL_VERIFYPEER, 0L);
  curl_easy_setopt(curl.get(), CURLOPT_SSL_VERIFYHOST, 0L);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEFUNCTION, &collect);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEDATA, &body);
  long status = 0;
  if (curl_easy_perform(curl.get()) != CURLE_OK) return std::nullopt;
  curl_easy_getinfo(curl.get(), CURLINFO_RESPONSE_CODE, &status);
  // /readyz returns 503 if the server is not ready.
  if (status != 200 && status != 503) return std::nullopt;
  return body;
}

}  // namespace

nlohmann::json machine_facts(const std::filesystem::path& data) {
  nlohmann::json facts;
  utsname system{};
  if (uname(&system) == 0)
    facts["system"] = {
        {"kernel", system.sysname}, {"release", system.release}, {"architecture", system.machine}};
  if (const auto release = read_settings("/etc/os-release"); release.contains("PRETTY_NAME"))
    facts["system"]["name"] = release.at("PRETTY_NAME");
  facts["cores"] = std::thread::hardware_concurrency();
  facts["load"] = first_line("/proc/loadavg");
  std::ifstream memory("/proc/meminfo");
  for (std::string line; std::getline(memory, line);)
    for (const char* name : {"MemTotal", "MemAvailable", "SwapTotal", "SwapFree", "Shmem"})
      if (line.starts_with(std::string(name) + ":"))
        facts["memory"][name] = trimmed(std::string_view(line).substr(line.find(':') + 1));
  const std::filesystem::path folder = std::filesystem::exists(data) ? data : ".";
  facts["disks"] = {{"data", disk(folder)}, {"temporary", disk("/tmp")}, {"root", disk("/")}};
  // Files of control groups, version 2. Without a limit, the text is "max".
  for (const char* limit : {"memory.max", "memory.high", "cpu.max", "pids.max"})
    facts["container"][limit] = first_line(std::filesystem::path("/sys/fs/cgroup") / limit);
  facts["container"]["docker"] = std::filesystem::exists("/.dockerenv");
  facts["container"]["podman"] = std::filesystem::exists("/run/.containerenv");
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0)
    facts["open_files"] = {{"soft", files.rlim_cur}, {"hard", files.rlim_max}};
  facts["is_root"] = geteuid() == 0;
  return facts;
}

nlohmann::json settings_facts(const std::filesystem::path& data, const std::string& database) {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    const auto equals = text.find('=');
    if (!text.starts_with("STRATA_") || equals == std::string::npos) continue;
    const std::string name = text.substr(0, equals);
    variables[name] = public_value(name, text.substr(equals + 1));
  }
  return {{"data", data.string()},
          {"database", database.empty() ? "private" : store::without_passwords(database).text},
          {"environment", variables},
          {"service", read_settings(kServiceSettings)}};
}

std::optional<std::string> ask_local_server(int port, const std::string& path) {
  for (const char* scheme : {"http://127.0.0.1:", "https://127.0.0.1:"})
    if (auto body = get(scheme + std::to_string(port) + path)) return body;
  return std::nullopt;
}

std::optional<std::string> last_lines(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::size_t>(std::max<std::streamoff>(0, in.tellg()));
  const std::size_t from = size > kMaxLog ? size - kMaxLog : 0;
  in.seekg(static_cast<std::streamoff>(from));
  std::ostringstream read;
  read << in.rdbuf();
  std::string text = std::move(read).str();
  // The first line may be incomplete.
  if (from > 0) text.erase(0, std::min(text.find('\n'), text.size() - 1) + 1);
  std::size_t begin = text.size();
  for (int lines = 0; begin > 0 && lines <= kMaxLines; ++lines) {
    const auto newline = begin < 2 ? std::string::npos : text.rfind('\n', begin - 2);
    begin = newline == std::string::npos ? 0 : newline + 1;
    if (lines + 1 == kMaxLines) break;
  }
  return text.substr(begin);
}

}  // namespace strata::cli

#include "cli/support_secrets.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <utility>

#include "core/digest.h"
#include "core/text/ascii.h"

namespace strata::cli {
namespace {

constexpr std::size_t kTokenLength = 43;  // core/secret.h
constexpr std::size_t kShort = 6;         // a shorter secret is likely to be part of a word

bool is_token_char(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

// Bytes above 127 are parts of letters.
bool is_word_char(char c) {
  return (is_token_char(c) && c != '-') || static_cast<unsigned char>(c) >= 0x80;
}

bool is_whole_word(std::string_view text, std::size_t at, std::size_t size) {
  return (at == 0 || !is_word_char(text[at - 1])) &&
         (at + size >= text.size() || !is_word_char(text[at + size]));
}

// Calls `visit(at, size)` for each longest run of token characters.
template <class Visit>
void for_each_run(std::string_view text, Visit visit) {
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_token_char(text[end])) ++end;
    if (end > at) visit(at, end - at);
    at = end + 1;
  }
}

// A run can be longer than the token that it contains, so every part of the run is tried.
bool has_hash_of(const std::unordered_set<std::string>& hashes, std::string_view run) {
  for (std::size_t at = 0; at + kTokenLength <= run.size(); ++at) {
    const Sha256 hash = sha256(run.substr(at, kTokenLength));
    if (hashes.contains(std::string(reinterpret_cast<const char*>(hash.data()), hash.size())))
      return true;
  }
  return false;
}

bool has(std::string_view text, std::string_view secret) {
  for (auto at = text.find(secret); at != std::string_view::npos; at = text.find(secret, at + 1))
    if (secret.size() >= kShort || is_whole_word(text, at, secret.size())) return true;
  return false;
}

}  // namespace

void KnownSecrets::add(std::string what, std::string text) {
  if (text.empty()) return;
  // JSON escapes some characters.
  const std::string json =
      nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (const auto inner = json.substr(1, json.size() - 2); inner != text)
    texts.push_back({what, inner});
  texts.push_back({std::move(what), std::move(text)});
}

std::optional<std::string> KnownSecrets::find_in(std::string_view text) const {
  for (const Secret& secret : texts)
    if (has(text, secret.text)) return secret.what;
  if (text.find("PRIVATE KEY-----") != std::string_view::npos) return "a private key";
  bool found = false;
  if (!hashes.empty())
    for_each_run(text, [&](std::size_t at, std::size_t size) {
      found = found || has_hash_of(hashes, text.substr(at, size));
    });
  if (found) return "a token or the secret of a link";
  return std::nullopt;
}

std::string redacted(std::string_view text) {
  std::string without_tokens;
  std::size_t copied = 0;
  for_each_run(text, [&](std::size_t at, std::size_t size) {
    if (size < kTokenLength) return;
    without_tokens.append(text.substr(copied, at - copied)).append("[token]");
    copied = at + size;
  });
  without_tokens.append(text.substr(copied));

  static const std::pair<std::regex, const char*> kForms[] = {
      {std::regex(R"re(([?&](?:link|token|secret|password)=)[^&\s"']+)re", std::regex::icase),
       "$1[secret]"},
      {std::regex(R"re((/kiosk/|/join#)[A-Za-z0-9_-]+)re"), "$1[secret]"},
      {std::regex(R"re((\w+://[^:/\s@"']+:)[^@\s/"']+@)re"), "$1[secret]@"},
      {std::regex(
           R"re(((?:password|passwd|secret|token)"?\s*[=:]\s*)('[^']*'|"[^"]*"|[^\s,;&]+))re",
           std::regex::icase),
       "$1[secret]"},
      {std::regex(R"re((Authorization:\s*\w+\s+)\S+)re", std::regex::icase), "$1[secret]"},
      // PostgreSQL writes values of rows after these words, and continues them after a tab.
      {std::regex(R"re(\b(DETAIL|STATEMENT|CONTEXT|QUERY):  .*)re"), "$1:  [left out]"},
      {std::regex(R"re(^\t.*)re"), "\t[left out]"},
  };
  // Processes one line at a time, because std::regex is recursive and logs can be very long.
  std::string result;
  for (std::size_t at = 0; at < without_tokens.size();) {
    const auto end = std::min(without_tokens.find('\n', at), without_tokens.size());
    std::string line = without_tokens.substr(at, end - at);
    if (line.size() <= 4096)
      for (const auto& [form, by] : kForms) line = std::regex_replace(line, form, by);
    else
      line = "[a line of " + std::to_string(line.size()) + " characters was left out]";
    result += line;
    if (end < without_tokens.size()) result += '\n';
    at = end + 1;
  }
  return result;
}

Pseudonyms::Pseudonyms(const std::vector<std::string>& names) {
  int number = 0;
  for (const std::string& name : names) {
    const std::string lower = to_lower(name);
    if (lower.empty() || lower == "owner") continue;
    pseudonyms_.emplace_back(lower, "person-" + std::to_string(++number));
  }
  // Longer names come first, because a full name may contain a user name.
  std::ranges::stable_sort(pseudonyms_, std::greater<>(),
                           [](const auto& entry) { return entry.first.size(); });
}

std::string Pseudonyms::replaced_in(std::string_view text) const {
  static const std::regex kFolder(R"(/home/[^/\s"':]+)");
  std::string result = std::regex_replace(std::string(text), kFolder, "/home/[person]");
  for (const auto& [name, pseudonym] : pseudonyms_) {
    const std::string lower = to_lower(result);
    std::string next;
    std::size_t copied = 0;
    for (auto at = lower.find(name); at != std::string::npos; at = lower.find(name, at + 1)) {
      if (at < copied || !is_whole_word(lower, at, name.size())) continue;
      next.append(result, copied, at - copied).append(pseudonym);
      copied = at + name.size();
    }
    result = next.append(result, copied, std::string::npos);
  }
  return result;
}

}  // namespace strata::cli

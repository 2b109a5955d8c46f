#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace strata::cli {

// The secrets that a support bundle must not contain.
struct KnownSecrets {
  struct Secret {
    std::string what;  // for the message: "the owner's token"
    std::string text;
  };
  std::vector<Secret> texts;
  std::unordered_set<std::string> hashes;  // SHA-256 of tokens and links, 32 bytes each

  // Ignores an empty text.
  void add(std::string what, std::string text);
  // Returns the description of the first secret in the text. Finds short secrets only as words.
  std::optional<std::string> find_in(std::string_view text) const;
};

// Replaces texts that look like secrets: tokens, links to sign in, links of kiosks, passwords in
// addresses and in connection strings.
std::string redacted(std::string_view text);

// Replaces names of people by pseudonyms. Each name always has the same pseudonym.
class Pseudonyms {
 public:
  // Names of the server's own accounts, such as owner, are kept.
  explicit Pseudonyms(const std::vector<std::string>& names);
  // Replaces only whole words, and ignores case. Also replaces the folders of users.
  std::string replaced_in(std::string_view text) const;

 private:
  std::vector<std::pair<std::string, std::string>> pseudonyms_;  // lower-case name; longest first
};

}  // namespace strata::cli

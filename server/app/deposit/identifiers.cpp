#include "app/deposit/identifiers.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <cstdint>

namespace strata::app {
namespace {

constexpr License kLicenses[] = {
    {"CC0-1.0", "Creative Commons Zero v1.0 Universal",
     "https://creativecommons.org/publicdomain/zero/1.0/"},
    {"CC-BY-4.0", "Creative Commons Attribution 4.0 International",
     "https://creativecommons.org/licenses/by/4.0/"},
    {"CC-BY-SA-4.0", "Creative Commons Attribution Share Alike 4.0 International",
     "https://creativecommons.org/licenses/by-sa/4.0/"},
    {"CC-BY-NC-4.0", "Creative Commons Attribution Non Commercial 4.0 International",
     "https://creativecommons.org/licenses/by-nc/4.0/"},
    {"CC-BY-ND-4.0", "Creative Commons Attribution No Derivatives 4.0 International",
     "https://creativecommons.org/licenses/by-nd/4.0/"},
    {"CC-BY-NC-SA-4.0", "Creative Commons Attribution Non Commercial Share Alike 4.0 International",
     "https://creativecommons.org/licenses/by-nc-sa/4.0/"},
    {"CC-BY-NC-ND-4.0",
     "Creative Commons Attribution Non Commercial No Derivatives 4.0 International",
     "https://creativecommons.org/licenses/by-nc-nd/4.0/"},
    {"CC-BY-3.0", "Creative Commons Attribution 3.0 Unported",
     "https://creativecommons.org/licenses/by/3.0/"},
    {"CC-BY-SA-3.0", "Creative Commons Attribution Share Alike 3.0 Unported",
     "https://creativecommons.org/licenses/by-sa/3.0/"},
    {"ODbL-1.0", "Open Data Commons Open Database License v1.0",
     "https://opendatacommons.org/licenses/odbl/1-0/"},
    {"ODC-By-1.0", "Open Data Commons Attribution License v1.0",
     "https://opendatacommons.org/licenses/by/1-0/"},
    {"PDDL-1.0", "Open Data Commons Public Domain Dedication & License 1.0",
     "https://opendatacommons.org/licenses/pddl/1-0/"},
    {"etalab-2.0", "Etalab Open License 2.0",
     "https://www.etalab.gouv.fr/wp-content/uploads/2018/11/open-licence.pdf"},
    {"OGL-UK-3.0", "Open Government Licence v3.0",
     "http://www.nationalarchives.gov.uk/doc/open-government-licence/version/3/"},
    {"InC", "In Copyright", "http://rightsstatements.org/vocab/InC/1.0/", false},
    {"InC-OW-EU", "In Copyright - EU Orphan Work",
     "http://rightsstatements.org/vocab/InC-OW-EU/1.0/", false},
    {"InC-EDU", "In Copyright - Educational Use Permitted",
     "http://rightsstatements.org/vocab/InC-EDU/1.0/", false},
    {"InC-NC", "In Copyright - Non-Commercial Use Permitted",
     "http://rightsstatements.org/vocab/InC-NC/1.0/", false},
    {"InC-RUU", "In Copyright - Rights-holder(s) Unlocatable or Unidentifiable",
     "http://rightsstatements.org/vocab/InC-RUU/1.0/", false},
    {"NoC-CR", "No Copyright - Contractual Restrictions",
     "http://rightsstatements.org/vocab/NoC-CR/1.0/", false},
    {"NoC-NC", "No Copyright - Non-Commercial Use Only",
     "http://rightsstatements.org/vocab/NoC-NC/1.0/", false},
    {"NoC-OKLR", "No Copyright - Other Known Legal Restrictions",
     "http://rightsstatements.org/vocab/NoC-OKLR/1.0/", false},
    {"NoC-US", "No Copyright - United States", "http://rightsstatements.org/vocab/NoC-US/1.0/",
     false},
    {"CNE", "Copyright Not Evaluated", "http://rightsstatements.org/vocab/CNE/1.0/", false},
    {"UND", "Copyright Undetermined", "http://rightsstatements.org/vocab/UND/1.0/", false},
    {"NKC", "No Known Copyright", "http://rightsstatements.org/vocab/NKC/1.0/", false}};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Removes the first of the prefixes that the text begins with.
std::string_view without(std::string_view text, std::initializer_list<std::string_view> prefixes) {
  for (const std::string_view prefix : prefixes)
    if (boost::algorithm::istarts_with(text, prefix)) return text.substr(prefix.size());
  return text;
}

std::string_view without_scheme(std::string_view uri) {
  while (uri.ends_with('/')) uri.remove_suffix(1);
  return without(uri, {"https://", "http://"});
}

}  // namespace

std::optional<std::string> orcid_uri(std::string_view text) {
  const std::string_view number = without(text, {"https://orcid.org/", "http://orcid.org/"});
  constexpr std::size_t kLength = 19;  // 0000-0000-0000-0000
  if (number.size() != kLength) return std::nullopt;
  int total = 0;
  for (std::size_t i = 0; i + 1 < kLength; ++i) {
    if (i % 5 == 4) {
      if (number[i] != '-') return std::nullopt;
    } else {
      if (!is_digit(number[i])) return std::nullopt;
      total = (total + number[i] - '0') * 2 % 11;
    }
  }
  const int check = (12 - total) % 11;
  const char expected = check == 10 ? 'X' : static_cast<char>('0' + check);
  const char last = number.back() == 'x' ? 'X' : number.back();
  if (last != expected) return std::nullopt;
  return "https://orcid.org/" + std::string(number.substr(0, kLength - 1)) + last;
}

std::optional<std::string> ror_uri(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdefghjkmnpqrstvwxyz";  // base 32 of Crockford
  std::string id(without(text, {"https://ror.org/", "http://ror.org/", "ror.org/"}));
  boost::algorithm::to_lower(id);
  if (id.size() != 9 || id[0] != '0' || !is_digit(id[7]) || !is_digit(id[8])) return std::nullopt;
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < 7; ++i) {
    const auto digit = kDigits.find(id[i]);
    if (digit == std::string_view::npos) return std::nullopt;
    number = number * 32 + digit;
  }
  const std::uint64_t check = 98 - number * 100 % 97;
  if (check != static_cast<std::uint64_t>((id[7] - '0') * 10 + id[8] - '0')) return std::nullopt;
  return "https://ror.org/" + id;
}

std::optional<std::string> doi_of(std::string_view text) {
  const std::string_view doi = without(text, {"https://doi.org/", "http://doi.org/",
                                              "https://dx.doi.org/", "http://dx.doi.org/", "doi:"});
  if (!doi.starts_with("10.")) return std::nullopt;
  const auto slash = doi.find('/');
  if (slash == std::string_view::npos || slash + 1 == doi.size()) return std::nullopt;
  const std::string_view registrant = doi.substr(3, slash - 3);
  if (registrant.size() < 4 || registrant.size() > 9 || !std::ranges::all_of(registrant, is_digit))
    return std::nullopt;
  const auto is_plain = [](char c) { return c > ' ' && c != '"' && c != '<' && c != '>'; };
  if (!std::ranges::all_of(doi.substr(slash + 1), is_plain)) return std::nullopt;
  return std::string(doi);
}

std::span<const License> licenses() { return kLicenses; }

const License* find_license(std::string_view id_or_uri) {
  for (const License& license : kLicenses)
    if (boost::algorithm::iequals(license.id, id_or_uri) ||
        boost::algorithm::iequals(without_scheme(license.uri), without_scheme(id_or_uri)))
      return &license;
  return nullptr;
}

bool is_license(std::string_view id_or_uri) {
  if (find_license(id_or_uri)) return true;
  const std::string_view rest = without_scheme(id_or_uri);
  // The list contains all statements of this site.
  return rest.size() < id_or_uri.size() && rest.size() > 3 &&
         rest.find(' ') == std::string_view::npos &&
         !boost::algorithm::istarts_with(rest, "rightsstatements.org/");
}

}  // namespace strata::app

#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

// Identifiers of people, organizations, publications and licenses.
namespace strata::app {

// Returns the ORCID iD as https://orcid.org/…, or nothing if its form or its check digit (ISO 7064
// MOD 11-2) is wrong. Accepts the number with or without the address.
std::optional<std::string> orcid_uri(std::string_view text);
// Returns the ROR identifier as https://ror.org/…, or nothing if its form or its check digits
// (ISO 7064 MOD 97-10) are wrong. Accepts the identifier with or without the address.
std::optional<std::string> ror_uri(std::string_view text);
// Returns the DOI without an address (10.5281/zenodo.1), or nothing if the text is not a DOI.
std::optional<std::string> doi_of(std::string_view text);

// A license or a statement of rights.
struct License {
  std::string_view id;  // of SPDX, or the name of the statement at rightsstatements.org
  std::string_view name;
  std::string_view uri;
  bool is_spdx = true;
};
// The licenses for data that repositories accept, and the statements of rightsstatements.org.
std::span<const License> licenses();
// Finds a license by its identifier, ignoring case, or by its address. Returns null if it is not in
// the list.
const License* find_license(std::string_view id_or_uri);
// Returns whether the text is in the list or is another address on the web.
bool is_license(std::string_view id_or_uri);

}  // namespace strata::app

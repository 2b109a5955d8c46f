#include "app/deposit/metadata.h"

#include <algorithm>
#include <chrono>
#include <set>

#include "app/deposit/identifiers.h"
#include "core/text/edtf.h"
#include "protocol/parse.h"
#include "store/content/metadata.h"
#include "store/content/models.h"
#include "store/people/members.h"
#include "store/store.h"

namespace strata::app {
namespace {

using protocol::DepositAffiliation, protocol::DepositAgent, protocol::DepositRecord;

std::string at(const std::string& list, std::size_t place) {
  return list + "[" + std::to_string(place) + "]";
}

tl::unexpected<Error> refuse(const char* title, std::string detail, std::string field) {
  return fail(ErrorCode::invalid, title, std::move(detail), std::move(field));
}

Result<void> check_ror(std::optional<std::string>& ror, const std::string& field) {
  if (!ror) return {};
  auto uri = ror_uri(*ror);
  if (!uri)
    return refuse("Invalid ROR identifier",
                  "`" + *ror +
                      "` is not a ROR identifier, or one of its characters is wrong. Copy "
                      "it from https://ror.org, for example https://ror.org/04wxnsj81.",
                  field + ".ror");
  ror = std::move(*uri);
  return {};
}

Result<void> check_agent(DepositAgent& agent, const std::string& field) {
  const bool is_person = agent.kind == protocol::DepositAgentKind::person;
  if (agent.orcid && !is_person)
    return refuse("ORCID of an organization",
                  "Only people have an ORCID iD. Send `ror` for an organization.",
                  field + ".orcid");
  if (agent.ror && is_person)
    return refuse("ROR of a person",
                  "Only organizations have a ROR identifier. Send the organization of a person in "
                  "`affiliations`.",
                  field + ".ror");
  if (agent.orcid) {
    auto uri = orcid_uri(*agent.orcid);
    if (!uri)
      return refuse("Invalid ORCID iD",
                    "`" + *agent.orcid +
                        "` is not an ORCID iD, or one of its digits is wrong. It "
                        "has 16 digits, for example 0000-0002-1825-0097.",
                    field + ".orcid");
    agent.orcid = std::move(*uri);
  }
  STRATA_TRY(check_ror(agent.ror, field));
  if (agent.affiliations)
    for (std::size_t i = 0; i < agent.affiliations->size(); ++i)
      STRATA_TRY(check_ror((*agent.affiliations)[i].ror, at(field + ".affiliations", i)));
  return {};
}

Result<void> check_people(DepositRecord& record) {
  if (record.creators)
    for (std::size_t i = 0; i < record.creators->size(); ++i)
      STRATA_TRY(check_agent((*record.creators)[i], at("creators", i)));
  if (record.contributors)
    for (std::size_t i = 0; i < record.contributors->size(); ++i)
      STRATA_TRY(check_agent((*record.contributors)[i].agent, at("contributors", i) + ".agent"));
  if (record.publisher) STRATA_TRY(check_ror(record.publisher->ror, "publisher"));
  if (record.funding)
    for (std::size_t i = 0; i < record.funding->size(); ++i)
      STRATA_TRY(check_ror((*record.funding)[i].funder.ror, at("funding", i) + ".funder"));
  return {};
}

Result<void> check_dates(const DepositRecord& record) {
  if (!record.dates) return {};
  for (std::size_t i = 0; i < record.dates->size(); ++i) {
    const std::string& date = (*record.dates)[i].date;
    // DataCite has no dates that are approximate or have unknown digits.
    if (date.find_first_not_of("0123456789-/") != std::string::npos || !parse_edtf(date))
      return refuse("Invalid date",
                    "`" + date +
                        "` is not a date. Send a year, month or day, such as 2024-05-21, "
                        "or a period, such as 2024-05/2024-07.",
                    at("dates", i) + ".date");
  }
  return {};
}

Result<void> check_rights(DepositRecord& record) {
  if (!record.rights) return {};
  for (std::size_t i = 0; i < record.rights->size(); ++i) {
    auto& rights = (*record.rights)[i];
    if (rights.license) {
      const License* known = find_license(*rights.license);
      if (!known)
        return refuse("Unknown license",
                      "`" + *rights.license +
                          "` is not a known license. Send an SPDX identifier such as CC-BY-4.0, or "
                          "the address of the license in `uri`.",
                      at("rights", i) + ".license");
      rights.license = std::string(known->id);
      if (!rights.uri) rights.uri = std::string(known->uri);
    } else if (rights.uri && !is_license(*rights.uri)) {
      return refuse("Unknown statement of rights",
                    "`" + *rights.uri +
                        "` is not the address of a license or of a statement of "
                        "rightsstatements.org. Copy the address from its page.",
                    at("rights", i) + ".uri");
    }
  }
  return {};
}

Result<void> check_related(DepositRecord& record) {
  if (!record.related) return {};
  for (std::size_t i = 0; i < record.related->size(); ++i) {
    auto& related = (*record.related)[i];
    if (related.kind != protocol::DepositRelatedKind::doi) continue;
    auto doi = doi_of(related.identifier);
    if (!doi)
      return refuse("Invalid DOI",
                    "`" + related.identifier + "` is not a DOI, such as 10.5281/zenodo.1234567.",
                    at("related", i) + ".identifier");
    related.identifier = std::move(*doi);
  }
  return {};
}

// Returns a full name with the family name first, as DataCite and styles of citations expect it.
std::string family_first(const std::string& full_name) {
  const auto space = full_name.rfind(' ');
  if (space == std::string::npos || full_name.find(',') != std::string::npos) return full_name;
  return full_name.substr(space + 1) + ", " + full_name.substr(0, space);
}

// The license that all models have.
std::optional<std::string> common_rights(const std::vector<Model>& models) {
  std::set<std::string> rights;
  for (const Model& model : models) rights.insert(model.rights_uri);
  if (rights.size() != 1 || !is_license(*rights.begin())) return std::nullopt;
  return *rights.begin();
}

Result<DepositRecord> proposed(store::Store& store, const Project& project, bool with_people) {
  const auto models = STRATA_TRY(store.models().all(project.id));
  DepositRecord record;
  record.titles.emplace(1).front().title = project.name;
  if (!project.description.empty())
    record.descriptions.emplace(1).front().text = project.description;
  record.resource_type = "3D model with layers";
  const auto today = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
  record.year = static_cast<int>(std::chrono::year_month_day(today).year());
  std::vector<DepositAgent> creators;
  if (with_people) {
    const auto members = STRATA_TRY(store.members().of_project(project.id));
    for (const auto& member : members)
      if (!member.person.full_name.empty())
        creators.emplace_back().name = family_first(member.person.full_name);
  }
  const bool has_people = !creators.empty();
  std::set<std::string> makers;
  for (const Model& model : models)
    if (!model.creator.empty() && !has_people && makers.insert(model.creator).second)
      creators.emplace_back().name = model.creator;
  if (!creators.empty()) record.creators = std::move(creators);
  if (const auto rights = common_rights(models)) {
    const License* license = find_license(*rights);
    protocol::DepositRights proposal;
    if (license && license->is_spdx) proposal.license = std::string(license->id);
    proposal.uri = license ? std::string(license->uri) : *rights;
    record.rights.emplace().push_back(std::move(proposal));
  }
  return record;
}

}  // namespace

Result<DepositRecord> checked_metadata(DepositRecord record) {
  if (record.doi) {
    auto doi = doi_of(*record.doi);
    if (!doi)
      return refuse("Invalid DOI",
                    "`" + *record.doi +
                        "` is not a DOI. A DOI has the form "
                        "10.5281/zenodo.1234567.",
                    "doi");
    record.doi = std::move(*doi);
  }
  STRATA_TRY(check_people(record));
  STRATA_TRY(check_dates(record));
  STRATA_TRY(check_rights(record));
  STRATA_TRY(check_related(record));
  if (record.places)
    for (std::size_t i = 0; i < record.places->size(); ++i) {
      const auto& place = (*record.places)[i];
      if (place.longitude.has_value() != place.latitude.has_value())
        return refuse("Coordinate missing",
                      "A point needs both `longitude` and `latitude`. Send both or neither.",
                      at("places", i) + (place.longitude ? ".latitude" : ".longitude"));
    }
  return record;
}

std::vector<std::string> missing_for_doi(const DepositRecord& record) {
  std::vector<std::string> missing;
  if (!record.titles) missing.emplace_back("titles");
  if (!record.creators) missing.emplace_back("creators");
  if (!record.publisher) missing.emplace_back("publisher");
  if (!record.year) missing.emplace_back("year");
  if (!record.rights) missing.emplace_back("rights");
  return missing;
}

Result<ProjectMetadata> metadata_of(store::Store& store, const Project& project, bool with_people) {
  const auto stored = STRATA_TRY(store.metadata().of_project(project.id));
  if (stored.version == 0) {
    auto proposal = STRATA_TRY(proposed(store, project, with_people));
    return ProjectMetadata{std::move(proposal), 0};
  }
  auto record = STRATA_TRY(protocol::from_json<DepositRecord>(stored.record));
  return ProjectMetadata{std::move(record), stored.version};
}

}  // namespace strata::app

#include "app/deposit/datacite.h"

#include <nlohmann/json.hpp>

#include "app/deposit/identifiers.h"

namespace strata::app {
namespace {

using nlohmann::json;
using protocol::DepositAffiliation, protocol::DepositAgent, protocol::DepositRecord;

constexpr const char* kResourceType = "3D model with layers";
constexpr const char* kRor = "https://ror.org";

bool is_person(const DepositAgent& agent) {
  return agent.kind == protocol::DepositAgentKind::person;
}

json affiliation_json(const DepositAffiliation& affiliation) {
  json shown{{"name", affiliation.name}};
  if (affiliation.ror)
    shown.update({{"affiliationIdentifier", *affiliation.ror},
                  {"affiliationIdentifierScheme", "ROR"},
                  {"schemeUri", kRor}});
  return shown;
}

json agent_json(const DepositAgent& agent) {
  json shown{{"name", agent.name}, {"nameType", is_person(agent) ? "Personal" : "Organizational"}};
  if (const NameParts parts = name_parts(agent.name); is_person(agent) && !parts.given.empty())
    shown.update({{"familyName", parts.family}, {"givenName", parts.given}});
  if (agent.orcid)
    shown["nameIdentifiers"].push_back({{"nameIdentifier", *agent.orcid},
                                        {"nameIdentifierScheme", "ORCID"},
                                        {"schemeUri", "https://orcid.org"}});
  if (agent.ror)
    shown["nameIdentifiers"].push_back(
        {{"nameIdentifier", *agent.ror}, {"nameIdentifierScheme", "ROR"}, {"schemeUri", kRor}});
  if (agent.affiliations)
    for (const auto& affiliation : *agent.affiliations)
      shown["affiliation"].push_back(affiliation_json(affiliation));
  return shown;
}

// Sets a member of the JSON, if there is a value.
template <class T>
void put(json& shown, const char* name, const std::optional<T>& value) {
  if (value) shown[name] = *value;
}

json rights_json(const protocol::DepositRights& rights) {
  json shown = json::object();
  const License* known = rights.license ? find_license(*rights.license)
                         : rights.uri   ? find_license(*rights.uri)
                                        : nullptr;
  if (known) shown["rights"] = std::string(known->name);
  if (rights.text) shown["rights"] = *rights.text;
  put(shown, "rightsUri", rights.uri);
  if (known && known->is_spdx)
    shown.update({{"rightsIdentifier", std::string(known->id)},
                  {"rightsIdentifierScheme", "SPDX"},
                  {"schemeUri", "https://spdx.org/licenses/"}});
  return shown;
}

std::string related_kind(protocol::DepositRelatedKind kind) {
  using Kind = protocol::DepositRelatedKind;
  switch (kind) {
    case Kind::doi: return "DOI";
    case Kind::url: return "URL";
    case Kind::handle: return "Handle";
    case Kind::isbn: return "ISBN";
    case Kind::issn: return "ISSN";
    case Kind::ark: return "ARK";
    case Kind::urn: return "URN";
    case Kind::arxiv: return "arXiv";
  }
  return {};
}

json funding_json(const protocol::DepositFunding& funding) {
  json shown{{"funderName", funding.funder.name}};
  if (funding.funder.ror)
    shown.update({{"funderIdentifier", *funding.funder.ror}, {"funderIdentifierType", "ROR"}});
  put(shown, "awardNumber", funding.award_number);
  put(shown, "awardUri", funding.award_uri);
  put(shown, "awardTitle", funding.award_title);
  return shown;
}

json place_json(const protocol::DepositPlace& place) {
  json shown = json::object();
  put(shown, "geoLocationPlace", place.name);
  if (place.longitude && place.latitude)
    shown["geoLocationPoint"] = {{"pointLongitude", *place.longitude},
                                 {"pointLatitude", *place.latitude}};
  return shown;
}

}  // namespace

NameParts name_parts(const std::string& name) {
  const auto comma = name.find(',');
  if (comma == std::string::npos) return {name, {}};
  const auto given = name.find_first_not_of(' ', comma + 1);
  return {name.substr(0, comma), given == std::string::npos ? std::string() : name.substr(given)};
}

std::string datacite_name(std::string_view name) {
  std::string shown;
  bool is_first = true;
  for (const char c : name) {
    if (c == '_') {
      is_first = true;
      continue;
    }
    shown += is_first && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    is_first = false;
  }
  return shown;
}

json datacite_json(const DepositRecord& record) {
  json all{{"schemaVersion", kDataciteSchema},
           {"types",
            {{"resourceTypeGeneral", "Dataset"},
             {"resourceType", record.resource_type.value_or(kResourceType)}}}};
  put(all, "doi", record.doi);
  if (record.titles)
    for (const auto& title : *record.titles) {
      json shown{{"title", title.title}};
      put(shown, "lang", title.language);
      if (title.kind != protocol::DepositTitleKind::main) {
        const std::string kind = datacite_name(protocol::name(title.kind));
        shown["titleType"] =
            title.kind == protocol::DepositTitleKind::subtitle ? kind : kind + "Title";
      }
      all["titles"].push_back(std::move(shown));
    }
  if (record.creators)
    for (const auto& creator : *record.creators) all["creators"].push_back(agent_json(creator));
  if (record.contributors)
    for (const auto& contributor : *record.contributors) {
      json shown = agent_json(contributor.agent);
      shown["contributorType"] = datacite_name(protocol::name(contributor.contribution));
      all["contributors"].push_back(std::move(shown));
    }
  if (record.publisher) {
    all["publisher"] = {{"name", record.publisher->name}};
    if (record.publisher->ror)
      all["publisher"].update({{"publisherIdentifier", *record.publisher->ror},
                               {"publisherIdentifierScheme", "ROR"},
                               {"schemeUri", kRor}});
  }
  put(all, "publicationYear", record.year);
  put(all, "language", record.language);
  put(all, "version", record.version);
  if (record.subjects)
    for (const auto& subject : *record.subjects) {
      json shown{{"subject", subject.subject}};
      put(shown, "subjectScheme", subject.scheme);
      put(shown, "valueUri", subject.uri);
      put(shown, "lang", subject.language);
      all["subjects"].push_back(std::move(shown));
    }
  if (record.dates)
    for (const auto& date : *record.dates) {
      json shown{{"date", date.date}, {"dateType", datacite_name(protocol::name(date.kind))}};
      put(shown, "dateInformation", date.information);
      all["dates"].push_back(std::move(shown));
    }
  if (record.descriptions)
    for (const auto& description : *record.descriptions) {
      json shown{{"description", description.text},
                 {"descriptionType", datacite_name(protocol::name(description.kind))}};
      put(shown, "lang", description.language);
      all["descriptions"].push_back(std::move(shown));
    }
  if (record.rights)
    for (const auto& rights : *record.rights) all["rightsList"].push_back(rights_json(rights));
  if (record.related)
    for (const auto& related : *record.related)
      all["relatedIdentifiers"].push_back(
          {{"relatedIdentifier", related.identifier},
           {"relatedIdentifierType", related_kind(related.kind)},
           {"relationType", datacite_name(protocol::name(related.relation))}});
  if (record.funding)
    for (const auto& funding : *record.funding)
      all["fundingReferences"].push_back(funding_json(funding));
  if (record.places)
    for (const auto& place : *record.places) all["geoLocations"].push_back(place_json(place));
  return all;
}

}  // namespace strata::app

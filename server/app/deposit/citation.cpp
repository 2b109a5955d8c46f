#include "app/deposit/citation.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "app/deposit/datacite.h"

namespace strata::app {
namespace {

using nlohmann::json;
using protocol::DepositAgent, protocol::DepositRecord;

constexpr const char* kDoi = "https://doi.org/";

const std::vector<DepositAgent>& creators_of(const DepositRecord& record) {
  static const std::vector<DepositAgent> kNone;
  return record.creators ? *record.creators : kNone;
}

bool is_person(const DepositAgent& agent) {
  return agent.kind == protocol::DepositAgentKind::person;
}

// The main title, or else the first one.
std::string title_of(const DepositRecord& record) {
  if (!record.titles) return {};
  const auto main = std::ranges::find(*record.titles, protocol::DepositTitleKind::main,
                                      &protocol::DepositTitle::kind);
  return main == record.titles->end() ? record.titles->front().title : main->title;
}

std::string description_of(const DepositRecord& record) {
  return record.descriptions ? record.descriptions->front().text : std::string();
}

// Escapes the characters that have a meaning in TeX.
std::string tex(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\textbackslash{}";
    } else if (c == '~') {
      escaped += "\\textasciitilde{}";
    } else if (c == '^') {
      escaped += "\\textasciicircum{}";
    } else {
      if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) escaped += '\\';
      escaped += c == '\n' || c == '\r' ? ' ' : c;
    }
  }
  return escaped;
}

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

json agent_of_schema_org(const DepositAgent& agent) {
  json shown{{"@type", is_person(agent) ? "Person" : "Organization"}, {"name", agent.name}};
  if (agent.orcid) shown["@id"] = *agent.orcid;
  if (agent.ror) shown["@id"] = *agent.ror;
  if (agent.affiliations)
    for (const auto& affiliation : *agent.affiliations) {
      json organization{{"@type", "Organization"}, {"name", affiliation.name}};
      if (affiliation.ror) organization["@id"] = *affiliation.ror;
      shown["affiliation"].push_back(std::move(organization));
    }
  return shown;
}

}  // namespace

std::string citation_text(const DepositRecord& record) {
  std::string text;
  const auto& creators = creators_of(record);
  for (std::size_t i = 0; i < creators.size(); ++i) {
    if (i > 0) text += i + 1 == creators.size() ? " & " : "; ";
    text += creators[i].name;
  }
  if (record.year) text += (text.empty() ? "(" : " (") + std::to_string(*record.year) + ")";
  if (!text.empty()) text += ". ";
  text += title_of(record);
  if (record.version) text += " (Version " + *record.version + ")";
  text += " [Dataset].";
  if (record.publisher) text += " " + record.publisher->name + ".";
  if (record.doi) text += " " + (kDoi + *record.doi);
  return one_line(std::move(text));
}

std::string bibtex(const DepositRecord& record, const std::string& key) {
  std::vector<std::pair<const char*, std::string>> fields;
  std::string authors;
  for (const DepositAgent& creator : creators_of(record)) {
    if (!authors.empty()) authors += " and ";
    authors += is_person(creator) ? tex(creator.name) : "{" + tex(creator.name) + "}";
  }
  if (!authors.empty()) fields.emplace_back("author", authors);
  fields.emplace_back("title", "{" + tex(title_of(record)) + "}");
  if (record.publisher) fields.emplace_back("publisher", tex(record.publisher->name));
  if (record.year) fields.emplace_back("year", std::to_string(*record.year));
  if (record.version) fields.emplace_back("version", tex(*record.version));
  if (record.language) fields.emplace_back("language", tex(*record.language));
  if (record.doi) {
    fields.emplace_back("doi", *record.doi);
    fields.emplace_back("url", kDoi + *record.doi);
  }
  std::string text = "@dataset{" + key + ",\n";
  for (const auto& [name, value] : fields)
    text += "  " + std::string(name) + " = {" + value + "},\n";
  return text + "}\n";
}

std::string ris(const DepositRecord& record) {
  std::string text;
  const auto add = [&](const char* tag, const std::string& value) {
    text += std::string(tag) + "  - " + one_line(value) + "\r\n";
  };
  add("TY", "DATA");
  for (const DepositAgent& creator : creators_of(record)) add("AU", creator.name);
  add("TI", title_of(record));
  if (record.year) add("PY", std::to_string(*record.year));
  if (record.publisher) add("PB", record.publisher->name);
  if (record.version) add("ET", *record.version);
  if (record.language) add("LA", *record.language);
  if (record.subjects)
    for (const auto& subject : *record.subjects) add("KW", subject.subject);
  if (const std::string description = description_of(record); !description.empty())
    add("AB", description);
  if (record.doi) {
    add("DO", *record.doi);
    add("UR", kDoi + *record.doi);
  }
  add("ER", "");
  return text;
}

json csl_json(const DepositRecord& record, const std::string& id) {
  json item{{"id", id}, {"type", "dataset"}, {"title", title_of(record)}};
  for (const DepositAgent& creator : creators_of(record)) {
    const NameParts parts = name_parts(creator.name);
    item["author"].push_back(is_person(creator) && !parts.given.empty()
                                 ? json{{"family", parts.family}, {"given", parts.given}}
                                 : json{{"literal", creator.name}});
  }
  if (record.publisher) item["publisher"] = record.publisher->name;
  if (record.year) item["issued"] = {{"date-parts", json::array({json::array({*record.year})})}};
  if (record.version) item["version"] = *record.version;
  if (record.language) item["language"] = *record.language;
  if (const std::string description = description_of(record); !description.empty())
    item["abstract"] = description;
  if (record.doi) {
    item["DOI"] = *record.doi;
    item["URL"] = kDoi + *record.doi;
  }
  return json::array({std::move(item)});
}

json schema_org(const DepositRecord& record) {
  json all{{"@context", "https://schema.org"}, {"@type", "Dataset"}, {"name", title_of(record)}};
  if (record.doi) all.update({{"@id", kDoi + *record.doi}, {"identifier", kDoi + *record.doi}});
  if (const std::string description = description_of(record); !description.empty())
    all["description"] = description;
  for (const DepositAgent& creator : creators_of(record))
    all["creator"].push_back(agent_of_schema_org(creator));
  if (record.contributors)
    for (const auto& contributor : *record.contributors)
      all["contributor"].push_back(agent_of_schema_org(contributor.agent));
  if (record.publisher) {
    all["publisher"] = {{"@type", "Organization"}, {"name", record.publisher->name}};
    if (record.publisher->ror) all["publisher"]["@id"] = *record.publisher->ror;
  }
  if (record.year) all["datePublished"] = std::to_string(*record.year);
  if (record.version) all["version"] = *record.version;
  if (record.language) all["inLanguage"] = *record.language;
  if (record.subjects)
    for (const auto& subject : *record.subjects) all["keywords"].push_back(subject.subject);
  if (record.rights)
    for (const auto& rights : *record.rights) {
      if (rights.uri) all["license"].push_back(*rights.uri);
      if (!rights.uri && rights.text) all["usageInfo"] = *rights.text;
    }
  if (record.funding)
    for (const auto& funding : *record.funding) {
      json funder{{"@type", "Organization"}, {"name", funding.funder.name}};
      if (funding.funder.ror) funder["@id"] = *funding.funder.ror;
      all["funder"].push_back(std::move(funder));
    }
  if (record.places)
    for (const auto& place : *record.places) {
      json shown{{"@type", "Place"}};
      if (place.name) shown["name"] = *place.name;
      if (place.longitude && place.latitude)
        shown["geo"] = {{"@type", "GeoCoordinates"},
                        {"longitude", *place.longitude},
                        {"latitude", *place.latitude}};
      all["spatialCoverage"].push_back(std::move(shown));
    }
  return all;
}

}  // namespace strata::app

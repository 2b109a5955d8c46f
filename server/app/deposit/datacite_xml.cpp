#include <nlohmann/json.hpp>

#include "app/deposit/datacite.h"
#include "core/text/printable.h"
#include "report/xml.h"

namespace strata::app {
namespace {

using nlohmann::json;
using report::set;

// The metadata may contain characters that XML does not allow.
pugi::xml_node add_text(pugi::xml_node parent, const char* element, const std::string& text) {
  return report::add_text(parent, element, printable(text));
}

std::string text_of(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// Sets an attribute to a member of the JSON, if it has the member.
void copy(pugi::xml_node node, const char* attribute, const json& from, const char* member) {
  if (const auto found = from.find(member); found != from.end())
    set(node, attribute, text_of(*found));
}

// Appends an element with the text of a member, if the JSON has it.
pugi::xml_node copy_text(pugi::xml_node parent, const char* element, const json& from,
                         const char* member) {
  const auto found = from.find(member);
  return found == from.end() ? pugi::xml_node() : add_text(parent, element, text_of(*found));
}

void add_agent(pugi::xml_node node, const std::string& name_element, const json& agent) {
  set(copy_text(node, name_element.c_str(), agent, "name"), "nameType", text_of(agent["nameType"]));
  copy_text(node, "givenName", agent, "givenName");
  copy_text(node, "familyName", agent, "familyName");
  for (const json& each : agent.value("nameIdentifiers", json::array())) {
    auto identifier = copy_text(node, "nameIdentifier", each, "nameIdentifier");
    copy(identifier, "nameIdentifierScheme", each, "nameIdentifierScheme");
    copy(identifier, "schemeURI", each, "schemeUri");
  }
  for (const json& each : agent.value("affiliation", json::array())) {
    auto affiliation = copy_text(node, "affiliation", each, "name");
    copy(affiliation, "affiliationIdentifier", each, "affiliationIdentifier");
    copy(affiliation, "affiliationIdentifierScheme", each, "affiliationIdentifierScheme");
    copy(affiliation, "schemeURI", each, "schemeUri");
  }
}

// Appends `list` with one element for each entry of a member, and calls `fill` for each.
template <class Fill>
void add_list(pugi::xml_node resource, const json& all, const char* member, const char* list,
              const char* element, const char* text_member, const Fill& fill) {
  const auto found = all.find(member);
  if (found == all.end()) return;
  auto parent = resource.append_child(list);
  for (const json& each : *found)
    fill(text_member ? add_text(parent, element, each.value(text_member, std::string()))
                     : parent.append_child(element),
         each);
}

void add_description_of_resource(pugi::xml_node resource, const json& all) {
  add_list(resource, all, "subjects", "subjects", "subject", "subject",
           [](pugi::xml_node node, const json& each) {
             copy(node, "subjectScheme", each, "subjectScheme");
             copy(node, "valueURI", each, "valueUri");
             copy(node, "xml:lang", each, "lang");
           });
  add_list(resource, all, "contributors", "contributors", "contributor", nullptr,
           [](pugi::xml_node node, const json& each) {
             copy(node, "contributorType", each, "contributorType");
             add_agent(node, "contributorName", each);
           });
  add_list(resource, all, "dates", "dates", "date", "date",
           [](pugi::xml_node node, const json& each) {
             copy(node, "dateType", each, "dateType");
             copy(node, "dateInformation", each, "dateInformation");
           });
  copy_text(resource, "language", all, "language");
}

void add_context(pugi::xml_node resource, const json& all) {
  add_list(resource, all, "relatedIdentifiers", "relatedIdentifiers", "relatedIdentifier",
           "relatedIdentifier", [](pugi::xml_node node, const json& each) {
             copy(node, "relatedIdentifierType", each, "relatedIdentifierType");
             copy(node, "relationType", each, "relationType");
           });
  copy_text(resource, "version", all, "version");
  add_list(resource, all, "rightsList", "rightsList", "rights", "rights",
           [](pugi::xml_node node, const json& each) {
             copy(node, "rightsURI", each, "rightsUri");
             copy(node, "rightsIdentifier", each, "rightsIdentifier");
             copy(node, "rightsIdentifierScheme", each, "rightsIdentifierScheme");
             copy(node, "schemeURI", each, "schemeUri");
           });
  add_list(resource, all, "descriptions", "descriptions", "description", "description",
           [](pugi::xml_node node, const json& each) {
             copy(node, "descriptionType", each, "descriptionType");
             copy(node, "xml:lang", each, "lang");
           });
  add_list(resource, all, "geoLocations", "geoLocations", "geoLocation", nullptr,
           [](pugi::xml_node node, const json& each) {
             if (const auto point = each.find("geoLocationPoint"); point != each.end()) {
               auto shown = node.append_child("geoLocationPoint");
               copy_text(shown, "pointLongitude", *point, "pointLongitude");
               copy_text(shown, "pointLatitude", *point, "pointLatitude");
             }
             copy_text(node, "geoLocationPlace", each, "geoLocationPlace");
           });
  add_list(resource, all, "fundingReferences", "fundingReferences", "fundingReference", nullptr,
           [](pugi::xml_node node, const json& each) {
             copy_text(node, "funderName", each, "funderName");
             copy(copy_text(node, "funderIdentifier", each, "funderIdentifier"),
                  "funderIdentifierType", each, "funderIdentifierType");
             copy(copy_text(node, "awardNumber", each, "awardNumber"), "awardURI", each,
                  "awardUri");
             copy_text(node, "awardTitle", each, "awardTitle");
           });
}

}  // namespace

// The order of elements is that of the schema.
std::string datacite_xml(const protocol::DepositRecord& record) {
  const json all = datacite_json(record);
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  set(declaration, "version", "1.0");
  set(declaration, "encoding", "UTF-8");
  auto resource = document.append_child("resource");
  set(resource, "xmlns", kDataciteSchema);
  set(resource, "xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
  set(resource, "xsi:schemaLocation",
      "http://datacite.org/schema/kernel-4 "
      "https://schema.datacite.org/meta/kernel-4.5/metadata.xsd");
  // The schema requires the element. The repository assigns the DOI.
  set(add_text(resource, "identifier", record.doi.value_or("(:tba)")), "identifierType", "DOI");
  add_list(resource, all, "creators", "creators", "creator", nullptr,
           [](pugi::xml_node node, const json& each) { add_agent(node, "creatorName", each); });
  add_list(resource, all, "titles", "titles", "title", "title",
           [](pugi::xml_node node, const json& each) {
             copy(node, "titleType", each, "titleType");
             copy(node, "xml:lang", each, "lang");
           });
  if (record.publisher) {
    auto publisher = add_text(resource, "publisher", record.publisher->name);
    copy(publisher, "publisherIdentifier", all["publisher"], "publisherIdentifier");
    copy(publisher, "publisherIdentifierScheme", all["publisher"], "publisherIdentifierScheme");
    copy(publisher, "schemeURI", all["publisher"], "schemeUri");
  }
  copy_text(resource, "publicationYear", all, "publicationYear");
  set(copy_text(resource, "resourceType", all["types"], "resourceType"), "resourceTypeGeneral",
      "Dataset");
  add_description_of_resource(resource, all);
  add_context(resource, all);
  return report::xml_text(document);
}

}  // namespace strata::app

#include "vocabulary/rdf.h"

#include <raptor2.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "core/text/utf8.h"
#include "vocabulary/xml_bounds.h"

namespace strata {
namespace {

// Only one call may run at a time, because libraptor2 sets the handlers of libxml2, which are
// global in the process.
std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

template <auto free>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    free(object);
  }
};
using World = std::unique_ptr<raptor_world, Freed<raptor_free_world>>;
using Uri = std::unique_ptr<raptor_uri, Freed<raptor_free_uri>>;
using Parser = std::unique_ptr<raptor_parser, Freed<raptor_free_parser>>;
using Serializer = std::unique_ptr<raptor_serializer, Freed<raptor_free_serializer>>;
using Statement = std::unique_ptr<raptor_statement, Freed<raptor_free_statement>>;

// The first error in the text, and its line.
struct Complaint {
  std::string text;
  int line = 0;
};

void note(void* user, raptor_log_message* message) {
  auto& complaint = *static_cast<Complaint*>(user);
  if (message->level < RAPTOR_LOG_LEVEL_ERROR || !complaint.text.empty()) return;
  complaint.text = message->text ? message->text : "unknown";
  complaint.line = message->locator ? std::max(0, message->locator->line) : 0;
}

World new_world(Complaint& complaint) {
  World world(raptor_new_world());
  if (!world) return world;
  // Prevents the initialization of the network library.
  raptor_world_set_flag(world.get(), RAPTOR_WORLD_FLAG_WWW_SKIP_INIT_FINISH, 1);
  raptor_world_set_log_handler(world.get(), &complaint, note);
  if (raptor_world_open(world.get()) != 0) world.reset();
  return world;
}

Uri new_uri(raptor_world* world, std::string_view text) {
  return Uri(raptor_new_uri_from_counted_string(
      world, reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

std::string text_of(const unsigned char* text, std::size_t size) {
  return text ? std::string(reinterpret_cast<const char*>(text), size) : std::string();
}

std::string name_of(const raptor_term* term) {
  if (term->type == RAPTOR_TERM_TYPE_BLANK)
    return "_:" + text_of(term->value.blank.string, term->value.blank.string_len);
  std::size_t size = 0;
  const unsigned char* iri = raptor_uri_as_counted_string(term->value.uri, &size);
  return text_of(iri, size);
}

struct Reading {
  const std::function<bool(const Triple&)>& sink;
  raptor_parser* parser;
  bool stopped = false;
};

void take(void* user, raptor_statement* statement) {
  auto& reading = *static_cast<Reading*>(user);
  if (reading.stopped) return;
  Triple triple;
  triple.subject = name_of(statement->subject);
  triple.predicate = name_of(statement->predicate);
  const raptor_term* object = statement->object;
  triple.is_literal = object->type == RAPTOR_TERM_TYPE_LITERAL;
  if (triple.is_literal) {
    const auto& literal = object->value.literal;
    triple.object = text_of(literal.string, literal.string_len);
    triple.language = text_of(literal.language, literal.language_len);
    std::transform(
        triple.language.begin(), triple.language.end(), triple.language.begin(),
        [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  } else {
    triple.object = name_of(object);
  }
  if (reading.sink(triple)) return;
  reading.stopped = true;
  raptor_parser_parse_abort(reading.parser);
}

raptor_term* new_term(raptor_world* world, const std::string& name) {
  const auto* text = reinterpret_cast<const unsigned char*>(name.data());
  if (name.starts_with("_:"))
    return raptor_new_term_from_counted_blank(world, text + 2, name.size() - 2);
  return raptor_new_term_from_counted_uri_string(world, text, name.size());
}

}  // namespace

bool is_iri(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0 || !is_letter(text.front())) return false;
  for (const char c : text.substr(0, colon))
    if (!is_letter(c) && !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != '.') return false;
  return is_utf8(text) && std::ranges::none_of(text, [](char c) {
           const auto byte = static_cast<unsigned char>(c);
           return byte <= ' ' || byte == 0x7f ||
                  std::string_view("<>\"{}|\\^`").find(c) != std::string_view::npos;
         });
}

Result<void> read_rdf(std::string_view text, RdfSyntax syntax,
                      const std::function<bool(const Triple&)>& sink) {
  const char* name = syntax == RdfSyntax::turtle ? "Turtle" : "RDF/XML";
  const auto refuse = [&](const std::string& why) {
    return fail(ErrorCode::invalid, std::string("Not ") + name,
                "The text cannot be read as " + std::string(name) + ": " + why, "body");
  };
  if (!is_utf8(text) || text.find('\0') != std::string_view::npos)
    return refuse("it is not UTF-8.");
  if (syntax == RdfSyntax::rdf_xml)
    if (auto good = check_xml_bounds(text); !good) return refuse(good.error().detail + ".");
  const std::lock_guard lock(one_at_a_time());
  Complaint complaint;
  const World world = new_world(complaint);
  const Parser parser(
      world ? raptor_new_parser(world.get(), syntax == RdfSyntax::turtle ? "turtle" : "rdfxml")
            : nullptr);
  if (!parser)
    return fail(ErrorCode::internal, "RDF not readable", "libraptor2 could not be started.");
  for (const auto& [option, value] :
       {std::pair(RAPTOR_OPTION_NO_NET, 1), std::pair(RAPTOR_OPTION_NO_FILE, 1),
        std::pair(RAPTOR_OPTION_LOAD_EXTERNAL_ENTITIES, 0)})
    if (raptor_parser_set_option(parser.get(), option, nullptr, value) != 0)
      return fail(ErrorCode::internal, "RDF not readable",
                  "The server could not turn off network access in libraptor2.");
  const Uri base = new_uri(world.get(), kRelativeBase);
  Reading reading{sink, parser.get()};
  raptor_parser_set_statement_handler(parser.get(), &reading, take);
  const bool started = base && raptor_parser_parse_start(parser.get(), base.get()) == 0;
  const bool read =
      started &&
      raptor_parser_parse_chunk(parser.get(), reinterpret_cast<const unsigned char*>(text.data()),
                                text.size(), 1) == 0;
  if (reading.stopped || (read && complaint.text.empty())) return {};
  const std::string where =
      complaint.line > 0 ? "line " + std::to_string(complaint.line) + ": " : std::string();
  return refuse(
      where +
      mended_utf8(complaint.text.empty() ? "its syntax is wrong" : complaint.text.substr(0, 300)) +
      ".");
}

Result<std::string> write_turtle(std::span<const Triple> triples,
                                 std::span<const RdfPrefix> prefixes) {
  const auto failed = [] {
    return fail(ErrorCode::internal, "Turtle not written", "libraptor2 could not write the terms.");
  };
  const std::lock_guard lock(one_at_a_time());
  Complaint complaint;
  const World world = new_world(complaint);
  const Serializer serializer(world ? raptor_new_serializer(world.get(), "turtle") : nullptr);
  if (!serializer) return failed();
  raptor_serializer_set_option(serializer.get(), RAPTOR_OPTION_RELATIVE_URIS, nullptr, 1);
  raptor_serializer_set_option(serializer.get(), RAPTOR_OPTION_WRITE_BASE_URI, nullptr, 0);
  for (const RdfPrefix& prefix : prefixes)
    raptor_serializer_set_namespace(serializer.get(), new_uri(world.get(), prefix.iri).get(),
                                    reinterpret_cast<const unsigned char*>(prefix.name.c_str()));
  const Uri base = new_uri(world.get(), kRelativeBase);
  void* text = nullptr;
  std::size_t size = 0;
  if (!base || raptor_serializer_start_to_string(serializer.get(), base.get(), &text, &size) != 0)
    return failed();
  bool good = true;
  for (const Triple& triple : triples) {
    const Statement statement(raptor_new_statement(world.get()));
    if (!statement) return failed();
    statement->subject = new_term(world.get(), triple.subject);
    statement->predicate = new_term(world.get(), triple.predicate);
    const auto* object = reinterpret_cast<const unsigned char*>(triple.object.data());
    const Uri datatype = triple.datatype.empty() ? Uri() : new_uri(world.get(), triple.datatype);
    statement->object =
        triple.is_literal
            ? raptor_new_term_from_counted_literal(
                  world.get(), object, triple.object.size(), datatype.get(),
                  triple.language.empty()
                      ? nullptr
                      : reinterpret_cast<const unsigned char*>(triple.language.c_str()),
                  static_cast<unsigned char>(triple.language.size()))
            : new_term(world.get(), triple.object);
    good = good && raptor_serializer_serialize_statement(serializer.get(), statement.get()) == 0;
  }
  good = raptor_serializer_serialize_end(serializer.get()) == 0 && good;
  const std::unique_ptr<void, Freed<raptor_free_memory>> holder(text);
  if (!good || !complaint.text.empty()) return failed();
  return text_of(static_cast<const unsigned char*>(text), size);
}

}  // namespace strata

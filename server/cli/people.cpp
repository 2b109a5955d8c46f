// `strata user` and `strata token`: accounts from the server's own machine, also while a server
// runs there.
#include <iomanip>
#include <iostream>
#include <iterator>

#include "cli/subcommands.h"
#include "store/content/projects.h"
#include "store/people/accounts.h"
#include "store/people/groups.h"
#include "store/people/members.h"
#include "store/people/password.h"
#include "store/people/tokens.h"

namespace strata::cli {
namespace {

using store::TokenKind;

struct PeopleOptions {
  DataOptions data;
  std::string name, role, project, full_name, user, url = "http://127.0.0.1:8080";
  std::int64_t token = 0;
  int days = 365;
  bool password_stdin = false;
};
using Options = std::shared_ptr<PeopleOptions>;

void add_role(CLI::App& command, const Options& options, const char* what) {
  command.add_option("--role", options->role, what)
      ->check(CLI::IsMember({"guest", "viewer", "annotator", "curator", "administrator"}));
}

void add_password(CLI::App& command, const Options& options) {
  command.add_flag(
      "--password-stdin", options->password_stdin,
      "Read the password from standard input, instead of printing a link to choose one");
  command.add_option("--url", options->url, "Address of the server, for the link")
      ->capture_default_str();
}

// From standard input; nothing where a link is wanted.
Result<std::optional<std::string>> given_password(const PeopleOptions& options,
                                                  const std::string& name) {
  if (!options.password_stdin) return std::nullopt;
  std::string password{std::istreambuf_iterator<char>(std::cin), {}};
  while (!password.empty() && (password.back() == '\n' || password.back() == '\r'))
    password.pop_back();
  STRATA_TRY(store::check_password(password, name, "--password-stdin"));
  return password;
}

// By the password that is given, or by a link under which the person chooses one.
Result<void> let_in(store::Store& store, const PeopleOptions& options, const store::Person& person,
                    const std::optional<std::string>& password) {
  if (password) {
    const auto hash = store::hash_password(*password);
    return hash ? store.accounts().set_password(person.name, *hash, {})
                : tl::unexpected(hash.error());
  }
  const auto link =
      store.tokens().create_link(TokenKind::invitation, person.name, store::kInvitationLifetime);
  if (!link) return tl::unexpected(link.error());
  std::cout << "For " << person.name << ", to choose a password within 7 days:\n"
            << options.url << "/join#" << link->secret << std::endl;
  return {};
}

Result<void> add_person(store::Store& store, const PeopleOptions& options) {
  // before there is anybody who would be left without
  const auto password = STRATA_TRY(given_password(options, options.name));
  const auto person = STRATA_TRY(store.accounts().create(
      options.name, options.full_name, parse_role(options.role).value_or(Role::annotator)));
  return let_in(store, options, person, password);
}

Result<void> renew(store::Store& store, const PeopleOptions& options, const store::Person& person) {
  const auto password = given_password(options, person.name);
  return password ? let_in(store, options, person, *password) : tl::unexpected(password.error());
}

void print(const store::Person& person, Role role) {
  std::cout << std::left << std::setw(24) << person.name << std::setw(15) << name(role)
            << std::setw(10)
            << (person.disabled       ? "disabled"
                : person.has_password ? "active"
                                      : "invited")
            << "last seen " << std::setw(12) << day_of(person.last_seen) << person.full_name
            << "\n";
}

Result<void> list_people(store::Store& store, const PeopleOptions& options) {
  if (!options.project.empty()) {
    const auto project = STRATA_TRY(store.projects().find(options.project));
    const auto members = STRATA_TRY(store.members().of_project(project.id));
    for (const store::Membership& member : members) print(member.person, member.role);
    const auto groups = STRATA_TRY(store.groups().of_project(project.id));
    for (const store::ProjectGroup& group : groups)
      std::cout << "group " << std::left << std::setw(18) << group.group.name << std::setw(15)
                << name(group.role) << group.group.people << " people\n";
    return {};
  }
  const auto people = STRATA_TRY(store.accounts().all());
  for (const store::Person& person : people) print(person, person.role);
  return {};
}

// Changes of one who is there.
Work<PeopleOptions> changing(
    std::function<Result<void>(store::Store&, const PeopleOptions&, const store::Person&)> change) {
  return [change = std::move(change)](store::Store& store,
                                      const PeopleOptions& options) -> Result<void> {
    const auto person = STRATA_TRY(store.accounts().find(options.name));
    return change(store, options, person);
  };
}

Result<void> change(store::Store& store, const store::Person& person,
                    const store::PersonChange& change) {
  if (person.role == Role::owner)
    return fail(ErrorCode::conflict, "The owner",
                "The owner stays the owner, and may always come in.");
  STRATA_TRY(store.accounts().update(person.id, change));
  return {};
}

Result<void> set_role_in_project(store::Store& store, const PeopleOptions& options,
                                 const store::Person& person) {
  const auto project = STRATA_TRY(store.projects().find(options.project));
  if (options.role == "none") return store.members().remove(project.id, person.name);
  const auto put =
      store.members().put(project.id, person.name, parse_role(options.role).value_or(Role::guest));
  if (!put) return tl::unexpected(put.error());
  return {};
}

Result<void> set_role(store::Store& store, const PeopleOptions& options,
                      const store::Person& person) {
  if (!options.project.empty()) return set_role_in_project(store, options, person);
  if (options.role == "none")
    return fail(ErrorCode::malformed, "No role", "Whoever is to see no project is a guest.",
                "role");
  return change(store, person, {.full_name = {}, .role = parse_role(options.role), .disabled = {}});
}

Work<PeopleOptions> disabling(bool disabled) {
  return changing(
      [disabled](store::Store& store, const PeopleOptions&, const store::Person& person) {
        return change(store, person, {.full_name = {}, .role = {}, .disabled = disabled});
      });
}

Result<void> remove_person(store::Store& store, const PeopleOptions&, const store::Person& person) {
  STRATA_TRY(change(store, person, {.full_name = {}, .role = {}, .disabled = true}));
  return store.accounts().remove(person.name);
}

// What somebody may do in a project: by their own role, by one there, and by those of their groups.
Result<Role> role_there(store::Store& store, const store::Person& person, ProjectId project) {
  Role role = person.role;
  const auto members = STRATA_TRY(store.members().of_project(project));
  for (const store::Membership& member : members)
    if (member.person.name == person.name) role = std::max(role, member.role);
  const auto given = STRATA_TRY(store.groups().roles_of(person.name));
  for (const store::GivenRole& one : given)
    if (one.project_id == project) role = std::max(role, one.role);
  return role;
}

Result<void> add_token_of(store::Store& store, const PeopleOptions& options) {
  const auto person = STRATA_TRY(store.accounts().find(options.user));
  Role own = person.role, usual = own;
  std::optional<ProjectId> only;
  if (!options.project.empty()) {
    const auto project = STRATA_TRY(store.projects().find(options.project));
    only = project.id;
    const auto there = STRATA_TRY(role_there(store, person, project.id));
    own = there;
    usual = std::min(own, Role::curator);
  }
  const Role role = parse_role(options.role).value_or(usual);
  if (role > own)
    return fail(ErrorCode::malformed, "Role above the person's",
                person.name + " is " + std::string(name(own)) + (only ? " there" : "") +
                    ": a token can do no more.",
                "--role");
  const auto made =
      store.tokens().create(TokenKind::script, person.name, role,
                            std::chrono::hours(24 * options.days), options.name, {}, only);
  if (!made) return tl::unexpected(made.error());
  std::cout << made->secret << std::endl;
  return {};
}

Result<void> list_tokens(store::Store& store, const PeopleOptions& options) {
  const auto person = STRATA_TRY(store.accounts().find(options.user));
  const auto tokens = STRATA_TRY(store.tokens().of_user(person.name, TokenKind::script));
  for (const store::Token& token : tokens)
    std::cout << std::left << std::setw(8) << token.id << std::setw(15) << name(token.role)
              << "until " << std::setw(12) << day_of(token.expires) << "last used " << std::setw(12)
              << day_of(token.last_used) << token.label
              << (token.project ? " (only " + *token.project + ")" : "") << "\n";
  return {};
}

Result<void> revoke_token(store::Store& store, const PeopleOptions& options) {
  const auto person = STRATA_TRY(store.accounts().find(options.user));
  return store.tokens().revoke(person.name, TokenKind::script, TokenId(options.token));
}

}  // namespace

Command add_user(CLI::App& app) {
  auto* parent = app.add_subcommand("user", "Accounts of this server");
  auto options = std::make_shared<PeopleOptions>();
  std::map<std::string, Work<PeopleOptions>> works;
  const auto add_named = [&](const char* name, const char* what, Work<PeopleOptions> work) {
    auto* command = add_subcommand(*parent, options, name, what);
    command->add_option("name", options->name, "What the person signs in with")->required();
    works[name] = std::move(work);
    return command;
  };
  auto* made = add_named("add", "A new account, and a link by which its person chooses a password",
                         add_person);
  add_role(*made, options, "What they may do (annotator)");
  made->add_option("--full-name", options->full_name, "How the page calls them");
  add_password(*made, options);
  add_subcommand(*parent, options, "list", "Everybody with an account")
      ->add_option("--project", options->project,
                   "Only those with a role in this project, and that role");
  works["list"] = list_people;
  auto* role = add_named("role", "What somebody may do", changing(set_role));
  role->add_option("role", options->role,
                   "guest, viewer, annotator, curator or administrator; in a project also none")
      ->required()
      ->check(CLI::IsMember({"guest", "viewer", "annotator", "curator", "administrator", "none"}));
  role->add_option("--project", options->project,
                   "What they may do there, where that is more than everywhere");
  add_password(
      *add_named("password", "A new link to choose a password, or a new password", changing(renew)),
      options);
  add_named("disable", "Signs somebody out everywhere, and lets them in no more", disabling(true));
  add_named("enable", "Lets somebody in again", disabling(false));
  add_named(
      "remove",
      "Deletes somebody; what they did stays, under a name that tells nothing. Beside a running server: disable them a minute before, "
      "or delete them on the page",
      changing(remove_person));
  return choosing<PeopleOptions>(parent, options, std::move(works));
}

Command add_token(CLI::App& app) {
  auto* parent = app.add_subcommand("token", "Tokens for scripts");
  auto options = std::make_shared<PeopleOptions>();
  options->user = "owner";
  const auto add_of = [&](const char* name, const char* what) {
    auto* command = add_subcommand(*parent, options, name, what);
    command->add_option("--user", options->user, "Whose token")->capture_default_str();
    return command;
  };
  auto* made = add_of("add", "A new token, printed this once");
  made->add_option("name", options->name, "What it is for")->required();
  add_role(*made, options, "At most what it may do (as its person)");
  made->add_option("--project", options->project, "The only project that it is good in");
  made->add_option("--days", options->days, "Until it expires")
      ->check(CLI::Range(1, 3650))
      ->capture_default_str();
  add_of("list", "Tokens of a person");
  add_of("revoke", "Makes a token worthless")
      ->add_option("id", options->token, "As `list` tells it")
      ->required();
  return choosing<PeopleOptions>(
      parent, options, {{"add", add_token_of}, {"list", list_tokens}, {"revoke", revoke_token}});
}

}  // namespace strata::cli

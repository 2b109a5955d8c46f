// `strata user` and `strata token` manage accounts. They run on the server's machine, even while
// the server is running.
#include <iomanip>
#include <iostream>
#include <iterator>

#include "cli/subcommands.h"
#include "store/content/projects.h"
#include "store/people/accounts.h"
#include "store/people/groups.h"
#include "store/people/members.h"
#include "store/people/password.h"
#include "store/people/sign_ons.h"
#include "store/people/tokens.h"

namespace strata::cli {
namespace {

using store::TokenKind;

struct PeopleOptions {
  DataOptions data;
  std::string name, role, project, full_name, user, url = "http://127.0.0.1:8080";
  std::string issuer, subject;
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

// Reads the password from standard input. Returns nothing if the user gets a link instead.
Result<std::optional<std::string>> given_password(const PeopleOptions& options,
                                                  const std::string& name) {
  if (!options.password_stdin) return std::nullopt;
  std::string password{std::istreambuf_iterator<char>(std::cin), {}};
  while (!password.empty() && (password.back() == '\n' || password.back() == '\r'))
    password.pop_back();
  STRATA_TRY(store::check_password(password, name, "--password-stdin"));
  return password;
}

// Sets the given password, or prints a link that lets the user choose a password.
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
  std::cout << "Link for " << person.name
            << " to choose a password; the link is valid for 7 days:\n"
            << options.url << "/join#" << link->secret << std::endl;
  return {};
}

Result<void> add_person(store::Store& store, const PeopleOptions& options) {
  // Reads the password first, so a failure leaves no account without a password.
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
            << (person.disabled                             ? "disabled"
                : person.has_password || person.has_sign_on ? "active"
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

// Returns a function that changes an existing account.
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
    return fail(ErrorCode::conflict, "Cannot change the owner",
                "The account of the owner cannot be disabled or deleted, and its role cannot be "
                "changed.");
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
    return fail(
        ErrorCode::malformed, "Project missing",
        "`none` requires --project. For an account that cannot see any project, choose the role "
        "guest.",
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

Result<void> bind_identity(store::Store& store, const PeopleOptions& options,
                           const store::Person& person) {
  return store.sign_ons().bind(person.name, options.issuer, options.subject);
}

// Returns the role of a user in a project. It is the highest of the user's roles on the site, in
// the project, and in groups.
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
    return fail(ErrorCode::malformed, "Role too high",
                person.name + " is " + std::string(name(own)) + (only ? " there" : "") +
                    ". A token cannot have a higher role.",
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
  auto* parent = app.add_subcommand("user", "Manage the accounts of this server");
  auto options = std::make_shared<PeopleOptions>();
  std::map<std::string, Work<PeopleOptions>> works;
  const auto add_named = [&](const char* name, const char* what, Work<PeopleOptions> work) {
    auto* command = add_subcommand(*parent, options, name, what);
    command->add_option("name", options->name, "User name")->required();
    works[name] = std::move(work);
    return command;
  };
  auto* made =
      add_named("add", "Create an account, and print a link to choose its password", add_person);
  add_role(*made, options, "Role (default: annotator)");
  made->add_option("--full-name", options->full_name, "Full name, shown on the page");
  add_password(*made, options);
  add_subcommand(*parent, options, "list", "List all accounts")
      ->add_option("--project", options->project,
                   "Only accounts with a role in this project; shows this role");
  works["list"] = list_people;
  auto* role = add_named("role", "Change the role of an account", changing(set_role));
  role->add_option("role", options->role,
                   "guest, viewer, annotator, curator or administrator; with --project: viewer, "
                   "annotator, curator or none, which removes the role")
      ->required()
      ->check(CLI::IsMember({"guest", "viewer", "annotator", "curator", "administrator", "none"}));
  role->add_option("--project", options->project,
                   "Change only the role in this project; the higher of both roles applies there");
  add_password(*add_named("password", "Print a link to choose a new password, or set a password",
                          changing(renew)),
               options);
  auto* bind = add_named("bind", "Let a person at an OpenID Connect provider use an account",
                         changing(bind_identity));
  bind->add_option("--issuer", options->issuer, "Issuer of the provider, as in --oidc-config")
      ->required();
  bind->add_option("--subject", options->subject, "The person's `sub` at the provider")->required();
  add_named("disable", "Disable an account and end its sessions", disabling(true));
  add_named("enable", "Enable a disabled account", disabling(false));
  add_named(
      "remove",
      "Delete an account. Its edits stay, under an anonymous name. If a server is running, disable the account a minute "
      "before, or delete the account on the page",
      changing(remove_person));
  return choosing<PeopleOptions>(parent, options, std::move(works));
}

Command add_token(CLI::App& app) {
  auto* parent = app.add_subcommand("token", "Manage tokens for scripts");
  auto options = std::make_shared<PeopleOptions>();
  options->user = "owner";
  const auto add_of = [&](const char* name, const char* what) {
    auto* command = add_subcommand(*parent, options, name, what);
    command->add_option("--user", options->user, "User of the token")->capture_default_str();
    return command;
  };
  auto* made = add_of("add", "Create a token; it is printed only once");
  made->add_option("name", options->name, "Purpose of the token")->required();
  add_role(*made, options, "Highest role of the token (default: the user's role)");
  made->add_option("--project", options->project, "Limit the token to this project");
  made->add_option("--days", options->days, "Days until the token expires")
      ->check(CLI::Range(1, 3650))
      ->capture_default_str();
  add_of("list", "List the tokens of a user");
  add_of("revoke", "Revoke a token")
      ->add_option("id", options->token, "Id from `list`")
      ->required();
  return choosing<PeopleOptions>(
      parent, options, {{"add", add_token_of}, {"list", list_tokens}, {"revoke", revoke_token}});
}

}  // namespace strata::cli

#include "store/store.h"

#include <set>

#include "store/cluster/migrations.h"
#include "store/store_impl.h"

namespace strata::store {

Store::Store() = default;
Store::~Store() = default;

Result<std::unique_ptr<Store>> Store::open(StoreOptions options,
                                           const std::filesystem::path& migrations_dir) {
  auto migrations = STRATA_TRY(read_migrations(migrations_dir));
  std::unique_ptr<Store> store(new Store);
  store->impl_ = std::make_unique<Impl>(std::move(options));
  auto connection = PgConnection::connect(store->impl_->options.dsn, kMigrationLimits);
  if (!connection) return tl::unexpected(connection.error());
  auto encoding = STRATA_TRY(connection->query("SELECT current_setting('server_encoding')"));
  if (encoding.text(0, 0) != "UTF8")
    return fail(ErrorCode::internal, "Database cannot be used",
                "The encoding of the database is " + encoding.text(0, 0) +
                    ". Create the database with ENCODING 'UTF8'.");
  const auto schema = STRATA_TRY(migrate(*connection, migrations));
  store->impl_->schema_version = schema.version();
  store->impl_->readable_from = schema.readable_from();
  if (const FilesPlace& files = store->impl_->options.files; !files.place.empty())
    STRATA_TRY(store->impl_->files.open(files));
  return store;
}

Projects& Store::projects() { return impl_->projects; }
Models& Store::models() { return impl_->models; }
Metadata& Store::metadata() { return impl_->metadata; }
Objects& Store::objects() { return impl_->objects; }
Bills& Store::bills() { return impl_->bills; }
SurfaceImages& Store::surface_images() { return impl_->images; }
Layers& Store::layers() { return impl_->layers; }
Tables& Store::tables() { return impl_->tables; }
Records& Store::records() { return impl_->records; }
Attachments& Store::attachments() { return impl_->attachments; }
Journal& Store::journal() { return impl_->journal; }
Accounts& Store::accounts() { return impl_->accounts; }
Members& Store::members() { return impl_->members; }
Tokens& Store::tokens() { return impl_->tokens; }
PersonalViews& Store::personal_views() { return impl_->personal_views; }
Tools& Store::tools() { return impl_->tools; }
Answers& Store::answers() { return impl_->answers; }
Comments& Store::comments() { return impl_->comments; }
NamedParts& Store::views() { return impl_->views; }
NamedParts& Store::tours() { return impl_->tours; }
NamedParts& Store::snapshots() { return impl_->snapshots; }
NamedParts& Store::selections() { return impl_->selections; }
Jobs& Store::jobs() { return impl_->jobs; }
Nodes& Store::nodes() { return impl_->nodes; }
Kiosks& Store::kiosks() { return impl_->kiosks; }
TourFiles& Store::tour_files() { return impl_->tour_files; }
Photographs& Store::photographs() { return impl_->photographs; }
Groups& Store::groups() { return impl_->groups; }
Trash& Store::trash() { return impl_->trash; }
Audit& Store::audit() { return impl_->audit; }
SignOns& Store::sign_ons() { return impl_->sign_ons; }
Files& Store::files() { return impl_->files; }

Result<StoreInfo> Store::info() {
  return impl_->pool.read([&](PgConnection& connection) -> Result<StoreInfo> {
    auto row = STRATA_TRY(connection.query(
        "SELECT current_setting('server_version'), pg_database_size(current_database())"));
    return StoreInfo{row.text(0, 0), impl_->schema_version, impl_->readable_from,
                     static_cast<std::uint64_t>(row.integer(0, 1))};
  });
}

bool Store::ready() {
  constexpr PgLimits kQuick{std::chrono::seconds(2), std::chrono::seconds(2),
                            std::chrono::seconds(2)};
  const std::unique_lock lock(impl_->probe_mutex, std::try_to_lock);
  if (!lock) return impl_->was_ready;
  auto& probe = impl_->probe;
  if (!probe || !probe->alive()) {
    auto fresh = PgConnection::connect(impl_->options.dsn, kQuick);
    probe.reset();
    if (fresh) probe.emplace(std::move(*fresh));
  }
  impl_->was_ready = probe && probe->query("SELECT 1");
  return impl_->was_ready;
}

Result<void> check_name(const std::string& name) {
  if (name.empty() || name.size() > kMaxNameLength)
    return fail(ErrorCode::malformed, "Invalid name",
                "`name` must be UTF-8 text of 1 to " + std::to_string(kMaxNameLength) + " bytes.",
                "name");
  return check_text(name, "name");
}

Result<void> check_texts(std::initializer_list<std::pair<const std::string*, const char*>> texts) {
  for (const auto& [text, field] : texts) STRATA_TRY(check_text(*text, field));
  return {};
}

Result<void> check_json(const nlohmann::json& json, const std::string& field) {
  if (json.is_string()) return check_text(json.get_ref<const std::string&>(), field);
  if (!json.is_structured()) return {};
  for (const auto& [key, value] : json.items()) {
    if (json.is_object()) STRATA_TRY(check_text(key, field));
    if (value.is_structured() || value.is_string())
      STRATA_TRY(check_json(value, field + "/" + key));
  }
  return {};
}

std::optional<std::int64_t> number_of(const std::string& ref) {
  if (!is_all_digits(ref)) return std::nullopt;
  return ref.size() > 18 ? 0 : std::stoll(ref);
}

PgArray visibilities_seen_by(Role role) {
  PgArray names(oid::kText);
  for (const Visibility each : {Visibility::everyone, Visibility::team, Visibility::curators})
    if (sees(role, each)) names.add(name(each));
  return names;
}

std::string free_slug(const std::string& requested, const PgResult& taken) {
  std::set<std::string> used;
  for (int i = 0; i < taken.rows(); ++i) used.insert(taken.text(i, 0));
  std::string slug = requested;
  for (int n = 2; used.contains(slug); ++n) slug = requested + "-" + std::to_string(n);
  return slug;
}

Result<PgResult> insert_with_slug(
    PgConnection& connection, const char* taken_sql, std::optional<std::int64_t> parent,
    const std::string& requested,
    const std::function<Result<PgResult>(const std::string&)>& insert) {
  const std::string base = make_slug(requested);
  for (;;) {
    Params params;
    params.text(base + "%");
    if (parent) params.integer(*parent);
    auto taken = STRATA_TRY(connection.query(taken_sql, params));
    auto row = insert(free_slug(base, taken));
    if (!row || row->rows() > 0) return row;
  }
}

}  // namespace strata::store

#include "store/pg/acting.h"

#include <deque>
#include <utility>

#include "store/pg/pg.h"

namespace strata::store {
namespace {

thread_local const Actor* acting = nullptr;

}  // namespace

ActingAs::ActingAs(Actor actor)
    : actor_(std::move(actor)), before_(std::exchange(acting, &actor_)) {}

ActingAs::~ActingAs() { acting = before_; }

const Actor* ActingAs::current() { return acting; }

Result<Transaction> begin_as_actor(PgConnection& connection) {
  if (!acting) return Transaction::begin(connection);
  std::deque<PgConnection::Statement> statements;
  statements.push_back({"BEGIN", {}});
  Params params;
  params.text(acting->kind).text(acting->name).text(acting->address);
  params.text(acting->sign_in).text(acting->provider);
  statements.push_back(
      {"SELECT set_config('strata.actor_kind', $1, true), set_config('strata.actor', $2, true), "
       "set_config('strata.address', $3, true), set_config('strata.sign_in', $4, true), "
       "set_config('strata.provider', $5, true)",
       std::move(params)});
  Transaction transaction = Transaction::adopt(connection);
  STRATA_TRY(connection.pipeline(statements));
  return transaction;
}

}  // namespace strata::store

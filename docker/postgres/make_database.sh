#!/usr/bin/env bash
# PostgreSQL's image runs this script once, if the data folder is empty. The script creates Strata's
# role, which is not a superuser, and a database that this role owns.
set -euo pipefail
psql --username "${POSTGRES_USER:-postgres}" --dbname postgres --no-psqlrc --quiet --set ON_ERROR_STOP=1 <<'SQL'
\getenv password STRATA_DATABASE_PASSWORD
CREATE ROLE strata LOGIN PASSWORD :'password';
-- So that it can end an analyst's session that keeps a table from being changed (docs/how-to/query-with-sql.md).
GRANT pg_signal_backend TO strata;
CREATE DATABASE strata OWNER strata;
SQL

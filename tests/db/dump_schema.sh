#!/bin/sh
# dump_schema.sh DSN: prints the schema of a database in a form that is the same on every machine.
# db/schema.sql is the result for a newly migrated database. To update it after adding a migration:
#   STRATA_UPDATE_GOLDEN=1 build/dev/bin/db_migrations_test --gtest_filter='*schema_file*'
set -eu
dump=$(find /usr/lib/postgresql -path '*/bin/pg_dump' 2>/dev/null | sort -V | tail -n 1)
"${dump:-pg_dump}" --schema-only --no-owner --no-privileges --dbname "$1" |
  sed -e '/^--/d' -e '/^SET /d' -e '/^SELECT pg_catalog.set_config/d' -e '/^\\restrict/d' -e '/^\\unrestrict/d' |
  cat -s | sed -e '1{/^$/d}'

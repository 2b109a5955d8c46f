-- migrate:up

-- The column that says what a record of the table is called. Nothing: the best one by rule (core/table, name_column).
ALTER TABLE record_tables ADD COLUMN title_column bigint REFERENCES record_columns ON DELETE SET NULL;

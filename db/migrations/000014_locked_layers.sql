-- migrate:up

-- What a curator has finished, or handed in for review: nobody below changes it until it is unlocked.
ALTER TABLE layers ADD COLUMN locked boolean NOT NULL DEFAULT false;

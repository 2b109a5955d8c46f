-- migrate:up
-- readable-from: 44

-- The nodes of a site send each other the people who look at a model (server/store/nodes/presence_channel.h). Any role that may connect to the
-- database can listen to a channel and send into it, but only if it knows the name of the channel. So the name is a secret, and only the role of the
-- server can read it here.
CREATE TABLE presence_channel (
  one boolean PRIMARY KEY DEFAULT true CHECK (one),
  name text NOT NULL CHECK (name ~ '^strata_presence_[0-9a-f]{32}$')
);
INSERT INTO presence_channel (name) VALUES ('strata_presence_' || replace(gen_random_uuid()::text, '-', ''));

CREATE SCHEMA records;

CREATE DOMAIN public.slug AS text
	CONSTRAINT slug_check CHECK (((VALUE ~ '^[a-z0-9-]+$'::text) AND (VALUE !~ '^[0-9]+$'::text)));

CREATE TABLE public.answers (
    key text NOT NULL,
    answer jsonb NOT NULL,
    "time" timestamp with time zone DEFAULT now() NOT NULL
);

CREATE TABLE public.attachments (
    id bigint NOT NULL,
    table_id bigint NOT NULL,
    sha256 bytea NOT NULL,
    name text NOT NULL,
    media_type text NOT NULL,
    width integer,
    height integer,
    user_name text NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    CONSTRAINT attachments_check CHECK (((width IS NULL) = (height IS NULL))),
    CONSTRAINT attachments_name_check CHECK ((name <> ''::text))
);

ALTER TABLE public.attachments ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.attachments_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.blob_chunks (
    sha256 bytea NOT NULL,
    chunk integer NOT NULL,
    data bytea NOT NULL
);
ALTER TABLE ONLY public.blob_chunks ALTER COLUMN data SET STORAGE EXTERNAL;

CREATE TABLE public.blobs (
    sha256 bytea NOT NULL,
    bytes bigint NOT NULL,
    CONSTRAINT blobs_sha256_check CHECK ((octet_length(sha256) = 32))
);

CREATE TABLE public.detail_levels (
    model_id bigint NOT NULL,
    level integer NOT NULL,
    geometry bytea NOT NULL,
    CONSTRAINT detail_levels_level_check CHECK ((level > 0))
);

CREATE TABLE public.edits (
    model_id bigint NOT NULL,
    sequence bigint NOT NULL,
    id uuid NOT NULL,
    layer_id bigint NOT NULL,
    stroke uuid NOT NULL,
    user_name text NOT NULL,
    op text NOT NULL,
    record jsonb NOT NULL,
    answer jsonb NOT NULL,
    "time" timestamp with time zone NOT NULL,
    in_force boolean DEFAULT true NOT NULL,
    undone_by bigint,
    writer boolean GENERATED ALWAYS AS ((op <> ALL (ARRAY['undo'::text, 'redo'::text]))) STORED NOT NULL,
    CONSTRAINT edits_check CHECK ((in_force = (undone_by IS NULL))),
    CONSTRAINT edits_sequence_check CHECK ((sequence > 0))
);

CREATE TABLE public.layer_inputs (
    layer_id bigint NOT NULL,
    slug text NOT NULL,
    input_id bigint,
    table_id bigint,
    table_sequence bigint DEFAULT 0 NOT NULL
);

CREATE TABLE public.layers (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    kind text NOT NULL,
    type text NOT NULL,
    resolution integer NOT NULL,
    unit text NOT NULL,
    description text NOT NULL,
    palette jsonb NOT NULL,
    opacity double precision NOT NULL,
    visible boolean NOT NULL,
    draw_order integer NOT NULL,
    sequence bigint DEFAULT 0 NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    table_id bigint,
    expression text,
    automatic boolean DEFAULT false NOT NULL,
    computed_sequence bigint DEFAULT 0 NOT NULL,
    CONSTRAINT layers_check CHECK (((kind = 'database'::text) = (table_id IS NOT NULL))),
    CONSTRAINT layers_check1 CHECK (((expression IS NOT NULL) OR (NOT automatic))),
    CONSTRAINT layers_expression_check CHECK ((expression <> ''::text)),
    CONSTRAINT layers_kind_check CHECK ((kind = ANY (ARRAY['numeric'::text, 'database'::text]))),
    CONSTRAINT layers_name_check CHECK ((name <> ''::text)),
    CONSTRAINT layers_opacity_check CHECK (((opacity >= (0)::double precision) AND (opacity <= (1)::double precision))),
    CONSTRAINT layers_resolution_check CHECK ((((resolution >= 128) AND (resolution <= 16384)) AND ((resolution & (resolution - 1)) = 0))),
    CONSTRAINT layers_type_check CHECK ((type = ANY (ARRAY['u8'::text, 'u16'::text, 'u32'::text, 'i8'::text, 'i16'::text, 'i32'::text, 'f16'::text, 'f32'::text])))
);

ALTER TABLE public.layers ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.layers_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.looks (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    description text NOT NULL,
    media_type text NOT NULL,
    width integer NOT NULL,
    height integer NOT NULL,
    opacity double precision NOT NULL,
    visible boolean NOT NULL,
    draw_order integer NOT NULL,
    picture bytea NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT looks_height_check CHECK ((height > 0)),
    CONSTRAINT looks_media_type_check CHECK ((media_type = ANY (ARRAY['image/jpeg'::text, 'image/png'::text]))),
    CONSTRAINT looks_name_check CHECK ((name <> ''::text)),
    CONSTRAINT looks_opacity_check CHECK (((opacity >= (0)::double precision) AND (opacity <= (1)::double precision))),
    CONSTRAINT looks_width_check CHECK ((width > 0))
);

ALTER TABLE public.looks ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.looks_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.model_sources (
    model_id bigint NOT NULL,
    name text NOT NULL,
    "position" integer NOT NULL,
    sha256 bytea NOT NULL
);

CREATE TABLE public.models (
    id bigint NOT NULL,
    project_id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    unit text NOT NULL,
    unit_assumed boolean NOT NULL,
    scale_verified boolean NOT NULL,
    up text NOT NULL,
    north text NOT NULL,
    crs text NOT NULL,
    origin double precision[] NOT NULL,
    bounds_min double precision[] NOT NULL,
    bounds_max double precision[] NOT NULL,
    triangles bigint NOT NULL,
    vertices bigint NOT NULL,
    area double precision NOT NULL,
    atlas jsonb NOT NULL,
    repairs jsonb NOT NULL,
    default_resolution integer NOT NULL,
    inventory_number text NOT NULL,
    owner text NOT NULL,
    creator text NOT NULL,
    captured text NOT NULL,
    method text NOT NULL,
    accuracy text NOT NULL,
    processing text NOT NULL,
    rights_uri text NOT NULL,
    credit text NOT NULL,
    geometry bytea NOT NULL,
    sequence bigint DEFAULT 0 NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT models_bounds_max_check CHECK ((cardinality(bounds_max) = 3)),
    CONSTRAINT models_bounds_min_check CHECK ((cardinality(bounds_min) = 3)),
    CONSTRAINT models_name_check CHECK ((name <> ''::text)),
    CONSTRAINT models_origin_check CHECK ((cardinality(origin) = 3)),
    CONSTRAINT models_unit_check CHECK ((unit = ANY (ARRAY['mm'::text, 'cm'::text, 'm'::text]))),
    CONSTRAINT models_up_check CHECK ((up = ANY (ARRAY['x'::text, 'y'::text, 'z'::text])))
);

ALTER TABLE public.models ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.models_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.projects (
    id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    description text NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT projects_name_check CHECK ((name <> ''::text))
);

ALTER TABLE public.projects ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.projects_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.record_columns (
    id bigint NOT NULL,
    table_id bigint NOT NULL,
    kind text NOT NULL,
    target bigint,
    properties jsonb NOT NULL,
    hidden boolean DEFAULT false NOT NULL,
    CONSTRAINT record_columns_kind_check CHECK ((kind = ANY (ARRAY['text'::text, 'integer'::text, 'numeric'::text, 'boolean'::text, 'date'::text, 'timestamp'::text, 'period'::text, 'enumeration'::text, 'url'::text, 'term'::text, 'relation'::text, 'picture'::text, 'document'::text])))
);

ALTER TABLE public.record_columns ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.record_columns_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.record_tables (
    id bigint NOT NULL,
    project_id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    labels jsonb DEFAULT '{}'::jsonb NOT NULL,
    description text DEFAULT ''::text NOT NULL,
    next_key bigint DEFAULT 1 NOT NULL,
    records bigint DEFAULT 0 NOT NULL,
    sequence bigint DEFAULT 0 NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT record_tables_name_check CHECK ((name <> ''::text))
);

ALTER TABLE public.record_tables ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.record_tables_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.schema_checksums (
    version character varying(128) NOT NULL,
    sha256 text NOT NULL
);

CREATE TABLE public.schema_migrations (
    version character varying(128) NOT NULL
);

CREATE TABLE public.table_changes (
    table_id bigint NOT NULL,
    subject text NOT NULL,
    subject_id bigint NOT NULL,
    sequence bigint NOT NULL,
    before jsonb NOT NULL,
    after jsonb NOT NULL,
    CONSTRAINT table_changes_subject_check CHECK ((subject = ANY (ARRAY['record'::text, 'column'::text])))
);

CREATE TABLE public.table_edits (
    table_id bigint NOT NULL,
    sequence bigint NOT NULL,
    user_name text NOT NULL,
    op text NOT NULL,
    record jsonb NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    in_force boolean DEFAULT true NOT NULL,
    undone_by bigint,
    writer boolean GENERATED ALWAYS AS ((op <> ALL (ARRAY['undo'::text, 'redo'::text]))) STORED NOT NULL,
    CONSTRAINT table_edits_check CHECK ((in_force = (undone_by IS NULL))),
    CONSTRAINT table_edits_sequence_check CHECK ((sequence > 0))
);

CREATE TABLE public.thumbnails (
    sha256 bytea NOT NULL,
    side integer NOT NULL,
    picture bytea NOT NULL
);
ALTER TABLE ONLY public.thumbnails ALTER COLUMN picture SET STORAGE EXTERNAL;

CREATE TABLE public.tile_revisions (
    layer_id bigint NOT NULL,
    tile_y smallint NOT NULL,
    tile_x smallint NOT NULL,
    sequence bigint NOT NULL,
    difference bytea NOT NULL,
    key_tile bytea
);
ALTER TABLE ONLY public.tile_revisions ALTER COLUMN difference SET STORAGE EXTERNAL;
ALTER TABLE ONLY public.tile_revisions ALTER COLUMN key_tile SET STORAGE EXTERNAL;

CREATE TABLE public.tokens (
    hash bytea NOT NULL,
    kind text NOT NULL,
    user_name text NOT NULL,
    role text NOT NULL,
    created timestamp with time zone DEFAULT now() NOT NULL,
    expires timestamp with time zone,
    revoked timestamp with time zone,
    CONSTRAINT tokens_hash_check CHECK ((octet_length(hash) = 32)),
    CONSTRAINT tokens_kind_check CHECK ((kind = ANY (ARRAY['session'::text, 'script'::text, 'owner_link'::text])))
);

CREATE TABLE public.tool_shapes (
    id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    cells bytea NOT NULL,
    created timestamp with time zone DEFAULT now() NOT NULL,
    deleted timestamp with time zone,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT tool_shapes_cells_check CHECK ((octet_length(cells) = 8192)),
    CONSTRAINT tool_shapes_name_check CHECK ((name <> ''::text)),
    CONSTRAINT tool_shapes_slug_check CHECK (((slug)::text <> ALL (ARRAY['disc'::text, 'square'::text])))
);

ALTER TABLE public.tool_shapes ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.tool_shapes_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.users (
    id bigint NOT NULL,
    name text NOT NULL,
    role text NOT NULL,
    created timestamp with time zone DEFAULT now() NOT NULL,
    CONSTRAINT users_name_check CHECK ((name <> ''::text))
);

ALTER TABLE public.users ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.users_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

ALTER TABLE ONLY public.answers
    ADD CONSTRAINT answers_pkey PRIMARY KEY (key);

ALTER TABLE ONLY public.attachments
    ADD CONSTRAINT attachments_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.blob_chunks
    ADD CONSTRAINT blob_chunks_pkey PRIMARY KEY (sha256, chunk);

ALTER TABLE ONLY public.blobs
    ADD CONSTRAINT blobs_pkey PRIMARY KEY (sha256);

ALTER TABLE ONLY public.detail_levels
    ADD CONSTRAINT detail_levels_pkey PRIMARY KEY (model_id, level);

ALTER TABLE ONLY public.edits
    ADD CONSTRAINT edits_model_id_id_key UNIQUE (model_id, id);

ALTER TABLE ONLY public.edits
    ADD CONSTRAINT edits_pkey PRIMARY KEY (model_id, sequence);

ALTER TABLE ONLY public.layer_inputs
    ADD CONSTRAINT layer_inputs_pkey PRIMARY KEY (layer_id, slug);

ALTER TABLE ONLY public.layers
    ADD CONSTRAINT layers_model_id_slug_key UNIQUE (model_id, slug);

ALTER TABLE ONLY public.layers
    ADD CONSTRAINT layers_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.looks
    ADD CONSTRAINT looks_model_id_slug_key UNIQUE (model_id, slug);

ALTER TABLE ONLY public.looks
    ADD CONSTRAINT looks_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.model_sources
    ADD CONSTRAINT model_sources_pkey PRIMARY KEY (model_id, name);

ALTER TABLE ONLY public.models
    ADD CONSTRAINT models_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.models
    ADD CONSTRAINT models_slug_key UNIQUE (slug);

ALTER TABLE ONLY public.projects
    ADD CONSTRAINT projects_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.projects
    ADD CONSTRAINT projects_slug_key UNIQUE (slug);

ALTER TABLE ONLY public.record_columns
    ADD CONSTRAINT record_columns_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.record_tables
    ADD CONSTRAINT record_tables_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.record_tables
    ADD CONSTRAINT record_tables_slug_key UNIQUE (slug);

ALTER TABLE ONLY public.schema_checksums
    ADD CONSTRAINT schema_checksums_pkey PRIMARY KEY (version);

ALTER TABLE ONLY public.schema_migrations
    ADD CONSTRAINT schema_migrations_pkey PRIMARY KEY (version);

ALTER TABLE ONLY public.table_changes
    ADD CONSTRAINT table_changes_pkey PRIMARY KEY (table_id, subject, subject_id, sequence);

ALTER TABLE ONLY public.table_edits
    ADD CONSTRAINT table_edits_pkey PRIMARY KEY (table_id, sequence);

ALTER TABLE ONLY public.thumbnails
    ADD CONSTRAINT thumbnails_pkey PRIMARY KEY (sha256, side);

ALTER TABLE ONLY public.tile_revisions
    ADD CONSTRAINT tile_revisions_pkey PRIMARY KEY (layer_id, tile_y, tile_x, sequence);

ALTER TABLE ONLY public.tokens
    ADD CONSTRAINT tokens_pkey PRIMARY KEY (hash);

ALTER TABLE ONLY public.tool_shapes
    ADD CONSTRAINT tool_shapes_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.users
    ADD CONSTRAINT users_name_key UNIQUE (name);

ALTER TABLE ONLY public.users
    ADD CONSTRAINT users_pkey PRIMARY KEY (id);

CREATE INDEX answers_time ON public.answers USING btree ("time");

CREATE INDEX attachments_blob ON public.attachments USING btree (sha256);

CREATE INDEX attachments_table ON public.attachments USING btree (table_id);

CREATE INDEX detail_levels_geometry ON public.detail_levels USING btree (geometry);

CREATE INDEX edits_author ON public.edits USING btree (layer_id, user_name, in_force, sequence) WHERE writer;

CREATE INDEX edits_layer ON public.edits USING btree (layer_id, sequence);

CREATE INDEX edits_undone ON public.edits USING btree (layer_id, user_name, undone_by) WHERE (NOT in_force);

CREATE INDEX layer_inputs_input ON public.layer_inputs USING btree (input_id);

CREATE INDEX layer_inputs_table ON public.layer_inputs USING btree (table_id);

CREATE INDEX layers_automatic ON public.layers USING btree (id) WHERE automatic;

CREATE INDEX layers_table ON public.layers USING btree (table_id);

CREATE INDEX looks_picture ON public.looks USING btree (picture);

CREATE INDEX model_sources_blob ON public.model_sources USING btree (sha256);

CREATE INDEX models_geometry ON public.models USING btree (geometry);

CREATE INDEX models_project ON public.models USING btree (project_id);

CREATE UNIQUE INDEX record_columns_slug ON public.record_columns USING btree (table_id, ((properties ->> 'slug'::text))) WHERE (NOT hidden);

CREATE INDEX record_columns_target ON public.record_columns USING btree (target);

CREATE INDEX record_tables_project ON public.record_tables USING btree (project_id);

CREATE INDEX table_changes_edit ON public.table_changes USING btree (table_id, sequence);

CREATE INDEX table_edits_author ON public.table_edits USING btree (table_id, user_name, in_force, sequence) WHERE writer;

CREATE INDEX table_edits_time ON public.table_edits USING btree (table_id, "time");

CREATE INDEX tile_revisions_edit ON public.tile_revisions USING btree (layer_id, sequence);

CREATE INDEX tile_revisions_key ON public.tile_revisions USING btree (layer_id, tile_y, tile_x, sequence) WHERE (key_tile IS NOT NULL);

CREATE INDEX tokens_user ON public.tokens USING btree (user_name);

CREATE UNIQUE INDEX tool_shapes_slug ON public.tool_shapes USING btree (slug) WHERE (deleted IS NULL);

ALTER TABLE ONLY public.attachments
    ADD CONSTRAINT attachments_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.attachments
    ADD CONSTRAINT attachments_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.blob_chunks
    ADD CONSTRAINT blob_chunks_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256) ON DELETE CASCADE;

ALTER TABLE ONLY public.detail_levels
    ADD CONSTRAINT detail_levels_geometry_fkey FOREIGN KEY (geometry) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.detail_levels
    ADD CONSTRAINT detail_levels_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.edits
    ADD CONSTRAINT edits_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.edits
    ADD CONSTRAINT edits_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.layer_inputs
    ADD CONSTRAINT layer_inputs_input_id_fkey FOREIGN KEY (input_id) REFERENCES public.layers(id) ON DELETE SET NULL;

ALTER TABLE ONLY public.layer_inputs
    ADD CONSTRAINT layer_inputs_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.layer_inputs
    ADD CONSTRAINT layer_inputs_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE SET NULL;

ALTER TABLE ONLY public.layers
    ADD CONSTRAINT layers_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.layers
    ADD CONSTRAINT layers_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id);

ALTER TABLE ONLY public.looks
    ADD CONSTRAINT looks_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.looks
    ADD CONSTRAINT looks_picture_fkey FOREIGN KEY (picture) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.model_sources
    ADD CONSTRAINT model_sources_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.model_sources
    ADD CONSTRAINT model_sources_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.models
    ADD CONSTRAINT models_geometry_fkey FOREIGN KEY (geometry) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.models
    ADD CONSTRAINT models_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id);

ALTER TABLE ONLY public.record_columns
    ADD CONSTRAINT record_columns_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.record_columns
    ADD CONSTRAINT record_columns_target_fkey FOREIGN KEY (target) REFERENCES public.record_tables(id);

ALTER TABLE ONLY public.record_tables
    ADD CONSTRAINT record_tables_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id);

ALTER TABLE ONLY public.table_changes
    ADD CONSTRAINT table_changes_table_id_sequence_fkey FOREIGN KEY (table_id, sequence) REFERENCES public.table_edits(table_id, sequence) ON DELETE CASCADE;

ALTER TABLE ONLY public.table_edits
    ADD CONSTRAINT table_edits_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.thumbnails
    ADD CONSTRAINT thumbnails_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256) ON DELETE CASCADE;

ALTER TABLE ONLY public.tile_revisions
    ADD CONSTRAINT tile_revisions_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.tokens
    ADD CONSTRAINT tokens_user_name_fkey FOREIGN KEY (user_name) REFERENCES public.users(name) ON UPDATE CASCADE ON DELETE CASCADE;


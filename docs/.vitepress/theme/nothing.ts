// Replaces the search service of another provider, which VitePress includes and the guide does not
// use.
export default {};

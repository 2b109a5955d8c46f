// In place of the search by a service of others, which VitePress brings and this guide does not use.
export default {};

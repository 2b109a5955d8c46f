// Replaces the Redoc modules that read other contract formats: several files, YAML and Swagger 2.
// The contract of Strata is one JSON file.
function unused(): never {
  throw new Error("Only one kind of contract is read here.");
}
export const bundle = unused;
export const bundleFromString = unused;
export const bundleDocument = unused;
export class Config {}
export default unused;

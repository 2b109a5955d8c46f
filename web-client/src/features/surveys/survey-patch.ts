// The change to a model's metadata that makes the model a survey of an object.

import type { SurveyedObject } from "../../core/protocol.gen";
import type { ModelPatch } from "../../core/types";
import type { Api } from "../../net/api";

/**
 * Returns the change that makes the model a survey of the object with this name at this date.
 * Creates the object if the project has none with this name. Without a name, the model leaves its
 * object.
 */
export async function surveyPatch(
  api: Api,
  project: string,
  objects: readonly SurveyedObject[],
  { name, date }: { name: string; date: string },
): Promise<ModelPatch> {
  if (name === "") return { object: 0 };
  const known = objects.find((object) => object.name.toLowerCase() === name.toLowerCase());
  const { id } =
    known ??
    (await api.json("POST /projects/{project}/objects", { path: { project }, body: { name } }));
  return { object: id, survey_date: date };
}

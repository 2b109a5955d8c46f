// What curators can do with an object of the model list: rename it, and split it up again.

import type { Api } from "../../net/api";
import type { SurveyedObject } from "../../core/protocol.gen";
import { ask, askText } from "../../ui/dialog";
import { texts } from "../../texts";

const words = texts.home;

/** Asks for a new name. Resolves without a change if the user cancels. */
export async function renameObject(
  api: Api,
  project: string,
  { id, name }: SurveyedObject,
): Promise<void> {
  const next = await askText({
    heading: words.rename_object_title(name),
    label: words.object_name,
    text: name,
    yes: texts.save,
  });
  if (!next || next === name) return;
  const path = { project, object: id };
  const { etag } = await api.versioned("GET /projects/{project}/objects/{object}", { path });
  await api.json("PATCH /projects/{project}/objects/{object}", {
    path,
    body: { name: next },
    header: { "If-Match": etag },
  });
}

/** Asks whether to delete an object, and deletes it. Its models remain. */
export async function deleteObject(
  api: Api,
  project: string,
  object: SurveyedObject,
): Promise<void> {
  const isCertain = await ask({
    heading: words.delete_title(object.name),
    lead: words.delete_object_lead,
    yes: texts.delete,
    danger: true,
  });
  if (isCertain) await splitUp(api, project, object);
}

/** Takes all models out of an object, and deletes the object. */
export async function splitUp(api: Api, project: string, { id }: SurveyedObject): Promise<void> {
  const path = { project, object: id };
  const { surveys } = await api.json("GET /projects/{project}/objects/{object}", { path });
  for (const { model } of surveys) {
    const { etag } = await api.versioned("GET /models/{model}", { path: { model } });
    await api.json("PATCH /models/{model}", {
      path: { model },
      body: { object: 0 },
      header: { "If-Match": etag },
    });
  }
  await api.deleteAsRead("DELETE /projects/{project}/objects/{object}", { path });
}

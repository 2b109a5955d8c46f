// The photographs of an open model.

import type { ModelSession } from "../../session/model-session";
import { Photographs } from "./photographs";

export const photographsOf = (session: ModelSession): Photographs =>
  (session.photographs ??= new Photographs(session.api, session.modelId, {
    camera: () => session.view.camera.message(),
    changed: () => session.changed("photographs"),
  }));

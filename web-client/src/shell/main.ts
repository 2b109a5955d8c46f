import { page_language } from "../core/locale";
import { chosen_language, follow_theme } from "../ui/preferences";
import { is_kiosk } from "../ui/routes";
import { load_texts } from "../texts";

async function start(): Promise<void> {
  if (is_kiosk(location.pathname)) return (await import("../kiosk/main")).start_kiosk();
  follow_theme();
  const chosen = chosen_language();
  const language = page_language(chosen, navigator.languages);
  document.documentElement.lang = language;
  await load_texts(language, chosen !== null, navigator.languages);
  await import("./strata-app"); // whose parts take their words while they are loaded
}

void start();

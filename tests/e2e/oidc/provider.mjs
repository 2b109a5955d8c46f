// An OpenID Connect provider for tests: `oidc-provider` on 127.0.0.1. OIDC_OPTIONS is JSON with the
// port and the clients. Prints `listening` when it is ready. Tests set the claims of a person with
// PUT /people/NAME. The address of an interaction with `?login=NAME` signs this person in, and with
// `?deny` refuses the sign-in. Without a query, it shows a form for browsers.
import { generateKeyPairSync } from "node:crypto";
import { createServer } from "node:http";
import Provider from "oidc-provider";

const { port, clients } = JSON.parse(process.env.OIDC_OPTIONS);
const issuer = `http://127.0.0.1:${port}`;
const people = new Map();

const key_of = (kid, alg, type, options) => ({
  ...generateKeyPairSync(type, options).privateKey.export({ format: "jwk" }),
  kid,
  alg,
  use: "sig",
});

const provider = new Provider(issuer, {
  clients,
  jwks: {
    keys: [
      key_of("rsa-1", "RS256", "rsa", { modulusLength: 2048 }),
      key_of("curve-1", "ES256", "ec", { namedCurve: "P-256" }),
    ],
  },
  cookies: { keys: ["a key of the tests"] },
  claims: {
    openid: ["sub"],
    profile: ["name", "preferred_username"],
    groups: ["groups", "realm_access"],
  },
  conformIdTokenClaims: false,
  features: { devInteractions: { enabled: false } },
  pkce: { methods: ["S256"], required: () => true },
  ttl: { Session: 600, Interaction: 600, Grant: 600, AccessToken: 60, IdToken: 60 },
  interactions: { url: (_, { uid }) => `/interaction/${uid}` },
  findAccount: (_, sub) => ({
    accountId: sub,
    claims: () => ({ sub, preferred_username: sub, ...people.get(sub) }),
  }),
  // Grants access without asking the person.
  async loadExistingGrant({ oidc }) {
    const grant = new oidc.provider.Grant({
      clientId: oidc.client.clientId,
      accountId: oidc.session.accountId,
    });
    grant.addOIDCScope(oidc.params.scope);
    await grant.save();
    return grant;
  },
});

async function body_of(request) {
  const chunks = [];
  for await (const chunk of request) chunks.push(chunk);
  return Buffer.concat(chunks).toString();
}

async function interact(request, response, query) {
  const login = query.get("login");
  if (login === null && !query.has("deny")) {
    response.setHeader("Content-Type", "text/html; charset=utf-8");
    response.end('<form><label>Name <input name="login"></label><button>Continue</button></form>');
    return;
  }
  const result = login === null ? { error: "access_denied" } : { login: { accountId: login } };
  await provider.interactionFinished(request, response, result, {
    mergeWithLastSubmission: false,
  });
}

const answer = provider.callback();
createServer(async (request, response) => {
  const { pathname, searchParams } = new URL(request.url, issuer);
  try {
    if (request.method === "PUT" && pathname.startsWith("/people/")) {
      people.set(
        decodeURIComponent(pathname.slice("/people/".length)),
        JSON.parse(await body_of(request)),
      );
      response.end();
    } else if (pathname.startsWith("/interaction/")) {
      await interact(request, response, searchParams);
    } else {
      await answer(request, response);
    }
  } catch (error) {
    response.statusCode = 500;
    response.end(String(error));
  }
}).listen(port, "127.0.0.1", () => console.log("listening"));

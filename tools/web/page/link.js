// SPDX-License-Identifier: MIT
// A scene in the address: #scene=PATH for one of the menu as it is, else #text= and {path, text, values} as JSON,
// deflated, in base64 for addresses. Nothing behind the # is sent to a server.
const MOST_BYTES = 8 << 20; // of a scene: a short address may hold much more

async function through(stream, bytes) {
  const writer = stream.writable.getWriter(), parts = [];
  writer.write(bytes).catch(() => {}); // what is wrong is found where it is read
  writer.close().catch(() => {});
  let count = 0;
  for (const reader = stream.readable.getReader(); ;) {
    const { done, value } = await reader.read();
    if (done) return new Uint8Array(await new Blob(parts).arrayBuffer());
    parts.push(value);
    if ((count += value.length) > MOST_BYTES) throw new Error("it is too long");
  }
}

function toBase64(bytes) {
  let text = "";
  for (let i = 0; i < bytes.length; i += 0x8000) text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

const fromBase64 = (text) => Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));

export async function writeLink({ path, text, values }, kept) {
  const isKept = kept.get(path) === text;
  if (isKept && !Object.keys(values).length) return `#scene=${path}`;
  const json = JSON.stringify({ path, text: isKept ? undefined : text, values });
  return `#text=${toBase64(await through(new CompressionStream("deflate-raw"), new TextEncoder().encode(json)))}`;
}

// null: there is none. Throws where it is broken.
export async function readLink(hash, kept) {
  const [, kind, rest] = /^#(scene|text)=(.*)$/.exec(hash) ?? [];
  if (kind === "scene") {
    const path = decodeURIComponent(rest);
    if (!kept.has(path)) throw new Error(`there is no scene ${path} here`);
    return { path, text: kept.get(path), values: {} };
  }
  if (kind !== "text") return null;
  let scene;
  try {
    const bytes = await through(new DecompressionStream("deflate-raw"), fromBase64(rest));
    scene = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
  } catch {
    throw new Error("the scene in the address is cut off or broken");
  }
  const { path, values } = scene ?? {}, text = scene?.text ?? kept.get(path);
  if (typeof path !== "string" || typeof text !== "string" || (values && typeof values !== "object"))
    throw new Error("the address holds no scene");
  return { path, text, values: values ?? {} };
}

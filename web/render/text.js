// Shader source: files of this folder, of the repository's sources and of its exports, fetched once.

const ROOT = new URL("../../", import.meta.url);
const fetched = new Map();

/** The text of a file, named from the root of the repository. */
export function text(path) {
  if (!fetched.has(path)) {
    const url = new URL(path, ROOT);
    const load = async () => {
      const answer = await fetch(url);
      if (!answer.ok) throw new Error(`${url.pathname}: ${answer.status} ${answer.statusText}`);
      return answer.text();
    };
    fetched.set(path, load());
  }
  return fetched.get(path);
}

/** The texts of several files, one after the other. */
export const texts = async (paths) => (await Promise.all(paths.map(text))).join("\n");

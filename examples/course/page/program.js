// The program of this page, in the page: WebAssembly that is run anew with other motions.

/** The bytes of a program that is written in base64 and compressed. */
function unpacked(text) {
  const gzip = new DecompressionStream('gzip');
  const writer = gzip.writable.getWriter();
  writer.write(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)));
  writer.close();
  return new Response(gzip.readable).arrayBuffer();
}

/** What a program prints that is started with these arguments. Of the system's functions it has those that print. */
function runProgram(module, args) {
  const texts = args.map((text) => new TextEncoder().encode(text + '\0'));
  const printed = [];
  let memory;
  const words = () => new DataView(memory.buffer);
  const put = (at, value) => words().setUint32(at, value, true);
  const system = {
    args_sizes_get: (count, size) => {
      put(count, texts.length);
      put(size, texts.reduce((sum, text) => sum + text.length, 0));
      return 0;
    },
    args_get: (list, at) => {
      texts.forEach((text, i) => {
        put(list + 4 * i, at);
        new Uint8Array(memory.buffer).set(text, at);
        at += text.length;
      });
      return 0;
    },
    environ_sizes_get: (count, size) => { put(count, 0); put(size, 0); return 0; },
    fd_write: (file, list, count, written) => {
      let all = 0;
      for (let i = 0; i < count; ++i) {
        const [at, size] = [words().getUint32(list + 8 * i, true), words().getUint32(list + 8 * i + 4, true)];
        printed.push(new Uint8Array(memory.buffer).slice(at, at + size));
        all += size;
      }
      put(written, all);
      return 0;
    },
    proc_exit: (code) => { throw new Error(`the program ended with ${code}`); },
  };
  const imports = {};
  for (const {module: from, name} of WebAssembly.Module.imports(module)) {
    (imports[from] ??= {})[name] = system[name] ?? (() => 0);
  }
  const {exports} = new WebAssembly.Instance(module, imports);
  memory = exports.memory;
  exports._start();
  const bytes = new Uint8Array(printed.reduce((sum, part) => sum + part.length, 0));
  printed.reduce((at, part) => { bytes.set(part, at); return at + part.length; }, 0);
  return new TextDecoder().decode(bytes);
}

/** The data of the page that the program writes for these motions, of elements and of points in drawings: JSON. */
function pageOf(module, motions, drawn) {
  return /^page: (.*)$/m.exec(runProgram(module, ['program', 'page', ...[motions, drawn].map(JSON.stringify)]))[1];
}

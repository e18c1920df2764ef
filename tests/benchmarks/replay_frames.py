"""How long a frame of a replay takes in Chromium without a graphics card: python3 replay_frames.py REPLAY.html

Prints milliseconds, means of some frames: `pose`, where bodies are and which colours they have; `mark`, the contacts
of the moment; `draw`, what the browser draws, by the processor, until the picture is complete. The first two are the
script's own, and the same with a graphics card.
"""

import re
import subprocess
import sys
import tempfile

DRIVER = """<script>
{
  const gl = renderer.getContext(), pixel = new Uint8Array(4), report = document.createElement("pre");
  const mean = (frames, work) => {
    const begin = performance.now();
    for (let i = 0; i < frames; ++i) work(data.duration * (i + 0.5) / frames);
    return Math.round(100 * (performance.now() - begin) / frames) / 100;
  };
  const picture = () => {
    renderer.render(scene, camera);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);  // waits until it is drawn
  };
  setPlaying(false);
  const fade = fadeSeconds * speed;
  pose(0, fade), picture();
  report.id = "report";
  report.textContent = JSON.stringify({
    bodies: data.bodies.length,
    pose: mean(60, t => pose(t, fade)),
    mark: mean(60, t => mark(t, fade, true)),
    draw: mean(3, picture),
  });
  document.body.append(report);
}
</script></body>"""


def main(file):
    with open(file, encoding="utf-8") as source:
        head, end, rest = source.read().rpartition("</body>")
    if not end:
        raise SystemExit(f"{file}: is no replay")
    with tempfile.TemporaryDirectory() as folder:
        page = folder + "/page.html"
        with open(page, "w", encoding="utf-8") as driven:
            driven.write(head + DRIVER + rest)
        command = ["chromium", "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader"]
        command += ["--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--window-size=1300,1000"]
        command += [f"--user-data-dir={folder}/profile", "--dump-dom", "file://" + page]
        done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=True)
    report = re.search(r'<pre id="report">([^<]*)', done.stdout)
    print(report.group(1) if report else "the page did not come to its end")


if __name__ == "__main__":
    main(*sys.argv[1:])

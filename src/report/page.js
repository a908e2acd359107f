// Turns the model of the page. Without WebGL 2 the picture stays.
(() => {
  const host = document.querySelector(".model");
  const data = document.getElementById("model");
  if (!host || !data) return;
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2", { antialias: true });
  if (!gl) return;

  // See src/report/page_model.cpp.
  const text = atob(data.textContent.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const head = new DataView(bytes.buffer);
  const vertices = head.getUint32(0, true);
  const triangles = head.getUint32(4, true);
  const largest = head.getFloat32(8, true) || 1;
  const sides = [12, 16, 20].map((at) => head.getFloat32(at, true) / largest);
  const corners = new Uint32Array(3 * triangles);
  let at = 24 + 8 * vertices;
  let next = 0;
  for (let i = 0; i < corners.length; ++i) {
    let back = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = bytes[at++];
      back |= (byte & 127) << shift;
      if (byte < 128) break;
    }
    corners[i] = next - back;
    if (back === 0) ++next;
  }

  const vertex_source = `#version 300 es
    in vec3 place; in float value;
    uniform mat3 turn; uniform vec3 sides; uniform float away, slope, aspect;
    out vec3 seen; out float error;
    void main() {
      seen = turn * ((place - 0.5) * sides);
      error = value;
      float z = away - seen.z;
      float near = max(0.02, away - 1.2), far = away + 1.2;
      gl_Position = vec4(seen.x / slope / aspect, seen.y / slope,
                         (far + near) / (far - near) * z - 2.0 * far * near / (far - near), z);
    }`;
  const fragment_source = `#version 300 es
    precision highp float;
    in vec3 seen; in float error;
    uniform sampler2D scale; uniform float by_error, edges;
    out vec4 colour;
    void main() {
      if (edges > 0.5) { colour = vec4(0.04, 0.06, 0.09, 0.4); colour.rgb *= colour.a; return; }
      vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
      if (normal.z < 0.0) normal = -normal;
      float light = 0.3 + 0.62 * max(0.0, dot(normal, normalize(vec3(-0.45, 0.6, 0.66))))
                  + 0.16 * max(0.0, dot(normal, normalize(vec3(0.7, -0.1, 0.5))));
      vec3 clay = vec3(0.84, 0.82, 0.79);
      vec3 base = mix(clay, texture(scale, vec2(error, 0.5)).rgb, by_error);
      if (!gl_FrontFacing) base *= vec3(0.93, 0.80, 0.72);
      colour = vec4(base * min(1.0, light + 0.06), 1.0);
    }`;
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex_source],
                                [gl.FRAGMENT_SHADER, fragment_source]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return;
  gl.useProgram(program);
  const uniform = (name) => gl.getUniformLocation(program, name);

  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, bytes.subarray(24, 24 + 8 * vertices), gl.STATIC_DRAW);
  const place = gl.getAttribLocation(program, "place");
  const value = gl.getAttribLocation(program, "value");
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, 3, gl.UNSIGNED_SHORT, true, 8, 0);
  gl.enableVertexAttribArray(value);
  gl.vertexAttribPointer(value, 1, gl.UNSIGNED_SHORT, true, 8, 6);
  const surface = gl.createBuffer();
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, surface);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
  let lines = null;  // made when they are asked for
  const make_lines = () => {
    const ends = new Uint32Array(2 * corners.length);
    for (let i = 0; i < corners.length; ++i) {
      ends[2 * i] = corners[i];
      ends[2 * i + 1] = corners[i % 3 === 2 ? i - 2 : i + 1];
    }
    lines = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, lines);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, ends, gl.STATIC_DRAW);
  };

  const stops = JSON.parse(data.dataset.scale);
  const texels = new Uint8Array(stops.flatMap((c) => [...c, 255]));
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, stops.length, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, texels);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.uniform3fv(uniform("sides"), sides);

  const slope = Math.tan(Math.PI / 12);
  const radius = Math.hypot(...sides) / 2;
  const first = JSON.parse(data.dataset.axes);  // rows: right, up, toward the viewer
  let turn = first.slice();
  const first_zoom = 1.12;  // few meshes are spheres
  let zoom = first_zoom;
  const shows = { error: true, edges: false };

  let waiting = false;
  const draw_soon = () => {
    if (!waiting) requestAnimationFrame(draw);
    waiting = true;
  };
  const draw = () => {
    waiting = false;
    const pixels = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.max(1, Math.round(canvas.clientWidth * pixels));
    const height = Math.max(1, Math.round(canvas.clientHeight * pixels));
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    const [a, b, c, d, e, f, g, h, i] = turn;
    gl.uniformMatrix3fv(uniform("turn"), false, [a, d, g, b, e, h, c, f, i]);
    gl.uniform1f(uniform("away"), (1.02 * radius) / Math.sin(Math.PI / 12));
    gl.uniform1f(uniform("slope"), slope / zoom);
    gl.uniform1f(uniform("aspect"), width / height);
    gl.uniform1f(uniform("by_error"), shows.error ? 1 : 0);
    gl.uniform1f(uniform("edges"), 0);
    gl.disable(gl.BLEND);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, surface);
    gl.drawElements(gl.TRIANGLES, corners.length, gl.UNSIGNED_INT, 0);
    if (!shows.edges) return;
    if (!lines) make_lines();
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.uniform1f(uniform("edges"), 1);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, lines);
    gl.drawElements(gl.LINES, 2 * corners.length, gl.UNSIGNED_INT, 0);
  };

  /// Round the axis that points up on the screen, then round the one to the right.
  const turn_by = (across, down) => {
    const [s, c] = [Math.sin(across), Math.cos(across)];
    const [t, d] = [Math.sin(down), Math.cos(down)];
    const by = [c, 0, s, t * s, d, -t * c, -d * s, t, d * c];
    const made = [];
    for (let row = 0; row < 3; ++row) {
      for (let column = 0; column < 3; ++column) {
        let sum = 0;
        for (let k = 0; k < 3; ++k) sum += by[3 * row + k] * turn[3 * k + column];
        made.push(sum);
      }
    }
    turn = made;
    draw_soon();
  };
  const zoom_by = (factor) => {
    zoom = Math.min(60, Math.max(0.5, zoom * factor));
    draw_soon();
  };

  const fingers = new Map();
  const spread = () => {
    const [p, q] = [...fingers.values()];
    return Math.hypot(p.x - q.x, p.y - q.y);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const wide = fingers.size === 2 ? spread() : 0;
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (fingers.size === 2) return zoom_by(spread() / Math.max(1, wide));
    const pace = 5 / Math.max(1, canvas.clientWidth) / Math.sqrt(zoom);
    turn_by((event.clientX - before.x) * pace, (event.clientY - before.y) * pace);
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
  }
  // With a key, so that the page itself can be scrolled.
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    zoom_by(Math.exp(-event.deltaY / 300));
  }, { passive: false });
  canvas.tabIndex = 0;
  canvas.addEventListener("keydown", (event) => {
    const steps = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1],
                    ArrowDown: [0, 0.1] };
    if (steps[event.key]) turn_by(...steps[event.key]);
    else if (event.key === "+") zoom_by(1.2);
    else if (event.key === "-") zoom_by(1 / 1.2);
    else return;
    event.preventDefault();
  });

  const buttons = document.querySelector(".buttons");
  const toggle = (name) => {
    const button = buttons.querySelector(`[data-shows="${name}"]`);
    button.setAttribute("aria-pressed", shows[name]);
    button.addEventListener("click", () => {
      shows[name] = !shows[name];
      button.setAttribute("aria-pressed", shows[name]);
      draw_soon();
    });
  };
  toggle("error");
  toggle("edges");
  const on = (name, act) =>
    buttons.querySelector(`[data-does="${name}"]`).addEventListener("click", act);
  on("nearer", () => zoom_by(1.4));
  on("farther", () => zoom_by(1 / 1.4));
  on("reset", () => {
    turn = first.slice();
    zoom = first_zoom;
    draw_soon();
  });

  host.append(canvas);
  host.classList.add("live");
  canvas.setAttribute("aria-label", "the result; drag to turn it");
  new ResizeObserver(draw_soon).observe(canvas);
  canvas.addEventListener("webglcontextlost", () => host.classList.remove("live"));
})();

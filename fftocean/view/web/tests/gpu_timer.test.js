import assert from 'node:assert/strict';
import test from 'node:test';
import { GpuTimer } from '../src/gpu_timer.js';

/** Return a context whose queries are answered with given times [ns], or one without queries. */
function context(times) {
  const clock = { TIME_ELAPSED_EXT: 1, GPU_DISJOINT_EXT: 2 };
  const open = [];
  let reads = 0;
  return {
    open,
    get reads() {
      return reads;
    },
    getExtension: () => (times ? clock : null),
    createQuery: () => ({}),
    beginQuery: (kind, query) => open.push(query),
    endQuery() {},
    deleteQuery() {},
    getParameter: () => false,
    getQueryParameter: (query, what) => (what === 'available' ? true : times.shift()),
    bindFramebuffer() {},
    readPixels: () => (reads += 1),
    QUERY_RESULT_AVAILABLE: 'available',
    QUERY_RESULT: 'result',
  };
}

test('times of the browser are averaged by name', () => {
  const timer = new GpuTimer(context([2e6, 4e6]));
  assert.equal(timer.milliseconds('sea'), null);
  let drawn = 0;
  for (let i = 0; i < 3; i++) timer.measure('sea', () => (drawn += 1));
  assert.equal(drawn, 3);
  const found = timer.milliseconds('sea');
  assert.ok(found > 2 && found < 4);
  assert.equal(timer.milliseconds('few'), null);
});

test('a part within another is drawn, not measured', () => {
  const gl = context([1e6, 1e6]);
  const timer = new GpuTimer(gl);
  let drawn = 0;
  timer.measure('sea', () => timer.measure('few', () => (drawn += 1)));
  assert.deepEqual([drawn, gl.open.length], [1, 1]);
});

test('without times of the browser, some pictures are waited for, if that is asked for', () => {
  const gl = context(null);
  const timer = new GpuTimer(gl);
  timer.measure('sea', () => {});
  assert.equal(timer.milliseconds('sea'), null);
  timer.waits = true;
  let drawn = 0;
  for (let i = 0; i < 5; i++) timer.measure('sea', () => (drawn += 1));
  assert.equal(drawn, 5);
  assert.equal(gl.reads, 2); // before and after the first
  assert.ok(timer.milliseconds('sea') >= 0);
});

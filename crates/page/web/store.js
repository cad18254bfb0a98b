// The run that this browser keeps, so that it continues after a reload: one header, and a record per case.
"use strict";

/** A database with one run. Without storage, as in private windows of some browsers, nothing is kept. */
class Store {
  #database = null;

  static async open() {
    const store = new Store();
    store.#database = await new Promise((resolve) => {
      try {
        const request = indexedDB.open("etalon", 1);
        request.onupgradeneeded = () => {
          request.result.createObjectStore("run");
          request.result.createObjectStore("records");
        };
        request.onsuccess = () => resolve(request.result);
        request.onerror = () => resolve(null);
        request.onblocked = () => resolve(null);
      } catch {
        resolve(null);
      }
    });
    return store;
  }

  /** Returns the seconds that a case took in the last run, or null. */
  get pace() {
    try {
      return Number(localStorage.getItem("pace")) || null;
    } catch {
      return null;
    }
  }

  set pace(seconds) {
    try {
      localStorage.setItem("pace", String(seconds));
    } catch {
      // The next run is guessed like the first one.
    }
  }

  /** Resolves when a transaction on both stores is complete; to null if there is no storage or it is full. */
  #done(mode, action) {
    if (this.#database === null) {
      return Promise.resolve(null);
    }
    return new Promise((resolve) => {
      try {
        const transaction = this.#database.transaction(["run", "records"], mode);
        const result = action(transaction.objectStore("run"), transaction.objectStore("records"));
        transaction.oncomplete = () => resolve(result);
        transaction.onabort = () => resolve(null);
      } catch {
        resolve(null);
      }
    });
  }

  /** Replaces the run. */
  begin(run) {
    return this.#done("readwrite", (runs, records) => {
      records.clear();
      runs.put(run, "current");
    });
  }

  /** Notes whether a person stopped the run. */
  note(stopped) {
    return this.#done("readwrite", (runs) => {
      const request = runs.get("current");
      request.onsuccess = () => request.result && runs.put({ ...request.result, stopped }, "current");
    });
  }

  /** Adds records: pairs of a number and a record. */
  add(added) {
    return this.#done("readwrite", (runs, records) => {
      for (const [number, record] of added) {
        records.put(record, number);
      }
    });
  }

  /** Returns the run and its records by number, or null. */
  async read() {
    const read = await this.#done("readonly", (runs, records) => [
      runs.get("current"),
      records.getAllKeys(),
      records.getAll(),
    ]);
    if (read === null || read[0].result === undefined) {
      return null;
    }
    const [run, numbers, records] = read.map((request) => request.result);
    return { run, records: new Map(numbers.map((number, i) => [number, records[i]])) };
  }
}

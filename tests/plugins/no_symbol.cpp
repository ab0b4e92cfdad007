// A shared object, but no plugin: it exports nothing.

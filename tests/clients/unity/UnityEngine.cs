// The few names of Unity that SeaHeights.cs uses, for a C# compiler without Unity. FromJson fills fields by name, as Unity's does.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Reflection;
using System.Text;

namespace UnityEngine
{
    public static class Mathf
    {
        // IEEE 754 half to single, by its definition
        public static float HalfToFloat(ushort bits)
        {
            int exponent = bits >> 10 & 31, fraction = bits & 1023;
            double size = exponent == 0 ? fraction * Math.Pow(2, -24) : (1 + fraction / 1024.0) * Math.Pow(2, exponent - 15);
            return (float)(bits >> 15 == 1 ? -size : size);
        }
    }

    public static class JsonUtility
    {
        public static T FromJson<T>(string text)
        {
            int at = 0;
            return (T)Fill(typeof(T), Value(text, ref at));
        }

        private static object Fill(Type type, object value)
        {
            if (type == typeof(string) || type == typeof(bool)) return value;
            if (type == typeof(int) || type == typeof(float)) return Convert.ChangeType(value, type, CultureInfo.InvariantCulture);
            if (type.IsArray)
            {
                var list = (List<object>)value;
                Array array = Array.CreateInstance(type.GetElementType(), list.Count);
                for (int i = 0; i < list.Count; i++) array.SetValue(Fill(type.GetElementType(), list[i]), i);
                return array;
            }
            object made = Activator.CreateInstance(type);
            var map = (Dictionary<string, object>)value;
            foreach (FieldInfo field in type.GetFields(BindingFlags.Instance | BindingFlags.Public))
                if (map.ContainsKey(field.Name)) field.SetValue(made, Fill(field.FieldType, map[field.Name]));
            return made;
        }

        private static void Space(string s, ref int at) { while (at < s.Length && char.IsWhiteSpace(s[at])) at++; }

        private static object Value(string s, ref int at)
        {
            Space(s, ref at);
            if (s[at] == '{' || s[at] == '[')
            {
                bool named = s[at++] == '{';
                var map = new Dictionary<string, object>();
                var list = new List<object>();
                for (Space(s, ref at); s[at] != '}' && s[at] != ']'; Space(s, ref at))
                {
                    object one = Value(s, ref at);
                    Space(s, ref at);
                    if (named) { at++; map[(string)one] = Value(s, ref at); Space(s, ref at); }
                    else list.Add(one);
                    if (s[at] == ',') at++;
                }
                at++;
                return named ? (object)map : list;
            }
            if (s[at] == '"')
            {
                var text = new StringBuilder();
                for (at++; s[at] != '"'; at++) text.Append(s[at] == '\\' ? s[++at] : s[at]);
                at++;
                return text.ToString();
            }
            int start = at;
            while (at < s.Length && !char.IsWhiteSpace(s[at]) && ",]}".IndexOf(s[at]) < 0) at++;
            string word = s.Substring(start, at - start);
            if (word == "true" || word == "false") return word == "true";
            return word == "null" ? null : (object)double.Parse(word, CultureInfo.InvariantCulture);
        }
    }
}
